// A web server on this machine's loopback address: the files of one folder, and single files from anywhere. Answers ranges.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace gim {

class PageServer {
  public:
    explicit PageServer(const std::string& folder);
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    // Serves a file as /file/NAME, where NAME is that of the path without its folders. It is read anew at each request.
    // Returns the address of the file, relative to that of the server, with characters escaped that have a meaning there.
    std::string add_file(const std::string& path);

    // Takes a port, 0: any that is free. Returns the server's address, without "/" at its end; empty if the port is taken.
    std::string bind(uint16_t port);

    // Answers until the process ends. Returns false if that fails.
    bool run();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace gim
