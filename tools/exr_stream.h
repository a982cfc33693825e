// Memory that OpenEXR writes to.
#pragma once

#include <ImfIO.h>

#include <algorithm>

#include "tools/file.h"

namespace gim {

// OpenEXR writes to a stream and seeks back to fill in its offset table.
class ExrStream : public Imf::OStream {
  public:
    ExrStream() : Imf::OStream("memory") {}
    void write(const char c[], int n) override {
        const auto count = static_cast<size_t>(n);
        if (position_ + count > bytes.size()) bytes.resize(position_ + count);
        std::copy(c, c + n, bytes.begin() + static_cast<std::ptrdiff_t>(position_));
        position_ += count;
    }
    uint64_t tellp() override { return position_; }
    void seekp(uint64_t position) override { position_ = position; }

    Bytes bytes;

  private:
    uint64_t position_ = 0;
};

}  // namespace gim
