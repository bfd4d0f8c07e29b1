// SPDX-FileCopyrightText: 2026 The ewa authors
// SPDX-License-Identifier: MIT
//
// DWA, by OpenEXR's C++. Nothing is thrown beyond this file.
#include "io/image/exr_dwa.h"

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>

namespace {

/// A file that lies in memory, whose beginning is another.
class bytes_stream : public Imf::IStream {
public:
    bytes_stream(const uint8_t *beginning, size_t beginning_bytes, const uint8_t *file, size_t file_bytes)
        : IStream("bytes"), head(beginning), bytes(file), head_bytes(beginning_bytes), size_bytes(file_bytes) {}

    bool read(char to[], int count) override {
        if (count < 0 || static_cast<uint64_t>(count) > size_bytes - at) throw std::runtime_error("it ends too early");
        const uint64_t end = at + static_cast<uint64_t>(count), of_head = at < head_bytes ? std::min(end, head_bytes) - at : 0;
        std::memcpy(to, head + (of_head ? at : 0), of_head);
        std::memcpy(to + of_head, bytes + at + of_head, static_cast<size_t>(count) - of_head);
        at = end;
        return at < size_bytes;
    }
    uint64_t tellg() override { return at; }
    void seekg(uint64_t position) override { at = position < size_bytes ? position : size_bytes; }

private:
    const uint8_t *head, *bytes;
    uint64_t head_bytes, size_bytes, at = 0;
};

} // namespace

ewa_exr_dwa_result ewa_exr_dwa_decode(const uint8_t *header, size_t header_bytes, const uint8_t *bytes, size_t size_bytes,
                                      const char *const *channels, uint32_t channel_count, uint32_t width_px, uint32_t height_px,
                                      float *pixels, char *reason, size_t reason_bytes) {
    try {
        bytes_stream stream(header, header_bytes, bytes, size_bytes);
        Imf::InputFile file(stream, 0); // in this thread
        const auto &window = file.header().dataWindow();
        if (int64_t{window.max.x} - window.min.x + 1 != width_px || int64_t{window.max.y} - window.min.y + 1 != height_px)
            throw std::runtime_error("its window is told in two ways");
        const size_t pixel_bytes = channel_count * sizeof(float);
        Imf::FrameBuffer frame;
        for (uint32_t c = 0; c < channel_count; c++)
            frame.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, pixels + c, window, pixel_bytes, width_px * pixel_bytes));
        file.setFrameBuffer(frame);
        file.readPixels(window.min.y, window.max.y);
        return EWA_EXR_DWA_DONE;
    } catch (const std::bad_alloc &) {
        return EWA_EXR_DWA_MEMORY;
    } catch (const std::exception &problem) {
        std::snprintf(reason, reason_bytes, "%s", problem.what());
    } catch (...) {
        std::snprintf(reason, reason_bytes, "DWA's bytes are broken");
    }
    return EWA_EXR_DWA_BROKEN;
}
