#include "tools/page_server.h"

#include <httplib.h>
#include <sys/socket.h>

#include <cctype>
#include <filesystem>
#include <map>

#include "tools/file.h"

namespace gim {
namespace {

constexpr const char* kHost = "127.0.0.1";

std::string escaped(const std::string& name) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    std::string text;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) != 0 || c == '.' || c == '-' || c == '_') {
            text += c;
        } else {
            text += {'%', kDigits[byte >> 4], kDigits[byte & 15]};
        }
    }
    return text;
}

}  // namespace

struct PageServer::State {
    httplib::Server server;
    std::map<std::string, std::string> paths;  // of files, by their names
    std::string host;                          // with the port

    void send_file(const httplib::Request& request, httplib::Response& response) const {
        const auto found = paths.find(request.matches[1].str());
        const Result<Bytes> bytes = found == paths.end() ? Result<Bytes>(Error{}) : read_file(found->second);
        if (!bytes.ok()) {
            response.status = 404;
            return;
        }
        const auto* const begin = reinterpret_cast<const char*>(bytes.value().data());
        response.set_content(std::string(begin, bytes.value().size()), "application/octet-stream");
    }

    // A page of elsewhere may know a name that leads to this machine. It must not read the files.
    httplib::Server::HandlerResponse refuse_strangers(const httplib::Request& request,
                                                      httplib::Response& response) const {
        const std::string asked = request.get_header_value("Host");
        const std::string port = host.substr(host.find(':'));
        if (asked == host || asked == "localhost" + port) return httplib::Server::HandlerResponse::Unhandled;
        response.status = 403;
        return httplib::Server::HandlerResponse::Handled;
    }
};

PageServer::PageServer(const std::string& folder) : state_(std::make_unique<State>()) {
    State& state = *state_;
    state.server.set_mount_point("/", folder, {{"Cache-Control", "no-cache"}});
    // Not the library's default, which shares a port that is taken.
    state.server.set_socket_options([](socket_t socket) {
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    state.server.set_default_headers({{"Cache-Control", "no-cache"}});
    state.server.Get("/file/(.*)", [&state](const httplib::Request& request, httplib::Response& response) {
        state.send_file(request, response);
    });
    state.server.set_pre_routing_handler([&state](const httplib::Request& request, httplib::Response& response) {
        return state.refuse_strangers(request, response);
    });
}

PageServer::~PageServer() = default;

std::string PageServer::add_file(const std::string& path) {
    const std::string name = std::filesystem::path(path).filename().string();
    state_->paths[name] = path;
    return "file/" + escaped(name);
}

std::string PageServer::bind(uint16_t port) {
    const int taken = port == 0                                  ? state_->server.bind_to_any_port(kHost)
                      : state_->server.bind_to_port(kHost, port) ? port
                                                                 : -1;
    if (taken <= 0) return {};
    state_->host = std::string(kHost) + ":" + std::to_string(taken);
    return "http://" + state_->host;
}

bool PageServer::run() { return state_->server.listen_after_bind(); }

}  // namespace gim
