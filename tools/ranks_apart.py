#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Runs an MPI program with every rank in a network namespace of its own, with a delay between them.

usage (as root, with Open MPI): tools/ranks_apart.py RANKS DELAY_MS PROGRAM ...

The namespaces are joined by devices (tun) whose packets this script carries, each DELAY_MS late: what tc netem does where
the kernel has it.
"""
import ctypes
import fcntl
import heapq
import os
import select
import struct
import subprocess
import sys
import tempfile
import threading
import time

TUNSETIFF, TUN_NO_INFO, CLONE_NEWNET = 0x400454CA, 0x1001, 0x40000000


def address(rank):
    return f"10.9.0.{11 + rank}"


def open_device(rank):
    """Opens the device of a rank's namespace, from within."""
    with open(f"/var/run/netns/ewa{rank}") as namespace:
        if ctypes.CDLL(None, use_errno=True).setns(namespace.fileno(), CLONE_NEWNET):
            raise OSError(ctypes.get_errno(), "setns")
    device = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(device, TUNSETIFF, struct.pack("16sH14x", b"ewa0", TUN_NO_INFO))
    subprocess.run(f"ip addr add {address(rank)}/24 dev ewa0; ip link set ewa0 up mtu 9000; ip link set lo up",
                   shell=True, check=True)
    return device


def carry(devices, delay_s):
    """Carries packets, each after the delay."""
    waiting, number = [], 0
    while True:
        until_s = max(0, waiting[0][0] - time.monotonic()) if waiting else 1
        for device in select.select(devices, [], [], until_s)[0]:
            try:
                while True:
                    packet = os.read(device, 65536)
                    number += 1
                    heapq.heappush(waiting, (time.monotonic() + delay_s, number, packet))
            except BlockingIOError:
                pass
        while waiting and waiting[0][0] <= time.monotonic():
            packet = heapq.heappop(waiting)[2]
            rank = packet[19] - 11  # the last byte of the destination's address
            if packet[0] >> 4 == 4 and 0 <= rank < len(devices):
                os.write(devices[rank], packet)


def main():
    ranks, delay_s, program = int(sys.argv[1]), float(sys.argv[2]) / 1000, sys.argv[3:]
    for rank in range(ranks):
        subprocess.run(["ip", "netns", "add", f"ewa{rank}"], check=True)
    try:
        with open("/proc/self/ns/net") as own:
            devices = [open_device(rank) for rank in range(ranks)]
            # mpirun is in the first one's network.
            with open("/var/run/netns/ewa0") as first:
                ctypes.CDLL(None).setns(first.fileno(), CLONE_NEWNET)
            threading.Thread(target=carry, args=(devices, delay_s), daemon=True).start()
            with tempfile.NamedTemporaryFile("w", suffix=".sh") as agent:
                agent.write('#!/bin/sh\nhost=$1; shift\nrank=$(( ${host##*.} - 11 ))\n'
                            'exec nsenter --net=/var/run/netns/ewa$rank unshare -u sh -c "hostname ewa$rank; $*"\n')
                agent.flush()
                os.chmod(agent.name, 0o755)
                hosts = ",".join(address(rank) for rank in range(ranks))
                environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
                options = ["--mca", "plm", "rsh", "--mca", "plm_rsh_agent", f"sh {agent.name}", "--mca", "btl", "tcp,self",
                           "--mca", "pml", "ob1", "--mca", "btl_tcp_if_include", "10.9.0.0/24",
                           "--mca", "oob_tcp_if_include", "10.9.0.0/24"]
                status = subprocess.run(["mpirun", *options, "--host", hosts, "-n", str(ranks), *program],
                                        env=environment).returncode
            ctypes.CDLL(None).setns(own.fileno(), CLONE_NEWNET)
    finally:
        for rank in range(ranks):
            subprocess.run(["ip", "netns", "del", f"ewa{rank}"])
    return status


if __name__ == "__main__":
    sys.exit(main())
