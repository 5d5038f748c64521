// sgm serve: a baked folder in a browser of this machine.
#include <fmt/format.h>
#include <httplib.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <thread>

#include "cli/commands.h"
#include "cli/requests.h"
#include "cli/validators.h"
#include "cli/watch.h"
#include "modeler/core/lower_case.h"
#include "modeler/tiles/page.h"

namespace sgm::cli {
namespace {

namespace fs = std::filesystem;

struct ServeOptions {
    std::string folder;
    int port = 8008;
    bool quiet = false;
};

/// What a file is to a browser.
const char* typeOf(const fs::path& file) {
    const std::string ending = lowerCase(file.extension().string());
    for (const auto& [known, type] : {std::pair(".html", "text/html; charset=utf-8"),
                                      {".js", "text/javascript; charset=utf-8"},
                                      {".json", "application/json"},
                                      {".geojson", "application/geo+json"},
                                      {".glb", "model/gltf-binary"},
                                      {".png", "image/png"},
                                      {".jpg", "image/jpeg"}})
        if (ending == known) return type;
    return "application/octet-stream";
}

/// The regular file of a request, below `root` also behind symbolic links; "" where there is none.
fs::path fileOf(const fs::path& root, const std::string& request) {
    std::error_code failed;
    const size_t name = std::min(request.find_first_not_of('/'), request.size());
    const fs::path asked = root / fs::path(name == request.size() ? "index.html" : request.substr(name));
    const fs::path file = fs::canonical(asked, failed);
    if (failed || !fs::is_regular_file(file, failed)) return {};
    const auto [inside, end] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
    return inside == root.end() ? file : fs::path();
}

void answer(const fs::path& root, const httplib::Request& request, httplib::Response& response) {
    const fs::path file = fileOf(root, request.path);
    std::ifstream in(file, std::ios::binary);
    if (file.empty() || !in) {
        response.status = 404;
        response.set_content("there is no such file in this folder\n", "text/plain");
        return;
    }
    response.set_header("Cache-Control", "no-cache");
    // As a provider: of plain content the library would pack texts anew for every request, which takes seconds.
    const auto bytes =
        std::make_shared<std::string>(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    response.set_content_provider(bytes->size(), typeOf(file),
                                  [bytes](size_t offset, size_t length, httplib::DataSink& sink) {
                                      return sink.write(bytes->data() + offset, length);
                                  });
}

Status serve(const ServeOptions& options) {
    std::error_code failed;
    if (fs::is_regular_file(options.folder, failed))
        return Error{Error::Kind::Input,
                     fmt::format("'{}' is a file: serve shows a folder of tiles, as `sgm bake` and `sgm merge` make "
                                 "them of a grammar",
                                 options.folder)};
    const fs::path root = fs::canonical(options.folder, failed);
    if (failed || !fs::exists(root / "tileset.json", failed))
        return Error{
            Error::Kind::Input,
            fmt::format("'{0}' holds no tileset.json: run `sgm bake` and `sgm merge {0}` first", options.folder)};
    if (!fs::exists(root / "index.html", failed))
        if (const Status s = tiles::writePage(root); !s.ok()) return s;
    httplib::Server server;
    // The library's own choice would let two servers share a port.
    server.set_socket_options([](socket_t socket) {
        const int yes = 1;
        setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server.Get(".*",
               [&](const httplib::Request& request, httplib::Response& response) { answer(root, request, response); });
    const char* host = "127.0.0.1";
    const int port =
        options.port > 0 ? server.bind_to_port(host, options.port) ? options.port : -1 : server.bind_to_any_port(host);
    if (port < 0)
        return Error{Error::Kind::Input, fmt::format("port {} is taken: end what listens there, or choose another one "
                                                     "(--port {}; 0 takes any)",
                                                     options.port, options.port % 65535 + 1)};
    if (!options.quiet) fmt::print("http://{}:{}/ shows '{}'; Ctrl-C ends it\n", host, port, options.folder);
    std::fflush(stdout);
    Watch watch(true);
    std::jthread ending([&](const std::stop_token& stop) {
        while (!stop.stop_requested() && !watch.progress()->cancelled())
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        server.stop();
    });
    server.listen_after_bind();
    return Done{};
}

}  // namespace

void addServe(CLI::App& app, int& exitCode) {
    CLI::App* command = app.add_subcommand("serve", "Show a baked city in a browser of this machine");
    auto options = std::make_shared<ServeOptions>();
    command->add_option("FOLDER", options->folder, "What `sgm merge` wrote")->required();
    command->add_option("--port", options->port, "Port on 127.0.0.1; 0 takes any that is free")
        ->check(wholeNumber(0, 65535))
        ->capture_default_str();
    command->add_flag("-q,--quiet", options->quiet, "Say nothing but errors");
    command->footer("Example:\n  sgm serve city");
    command->callback([options, &exitCode] {
        const Status done = serve(*options);
        exitCode = done.ok() ? 0 : fail(done.error());
    });
}

}  // namespace sgm::cli
