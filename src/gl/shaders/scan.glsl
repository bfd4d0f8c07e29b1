// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// Groups of 256 invocations that go over lists in blocks, and sums over all invocations of a group. First of its programs.

layout(local_size_x = 256) in;

const uint BLOCK = 4096u, NO_KEY = 0xffffffffu; // items of a block; no item

shared uint scanned[256];

// The sum of what all invocations up to this one have; `scanned[255]` is that of all, until the next call. All of a group call it.
uint sum_up_to(uint own) {
    uint at = gl_LocalInvocationIndex;
    barrier();
    scanned[at] = own;
    barrier();
    for (uint reach = 1u; reach < 256u; reach *= 2u) {
        uint other = at < reach ? 0u : scanned[at - reach];
        barrier();
        scanned[at] += other;
        barrier();
    }
    return scanned[at];
}

// Groups of a dispatch are numbered through.
uint group_number() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
