// A file descriptor that closes itself, and what the system says about failures.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <string>
#include <system_error>
#include <utility>

namespace gim {

// "Permission denied", "No space left on device", ...
inline std::string reason(int error) { return std::generic_category().message(error); }

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() { close_now(); }

    int get() const { return fd_; }
    // Closing may report a write that failed late (quota, network).
    bool close_now() {
        const int fd = std::exchange(fd_, -1);
        return fd < 0 || ::close(fd) == 0;
    }

  private:
    int fd_;
};

}  // namespace gim
