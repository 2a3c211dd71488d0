// serve: the report's page in the browser while its databases grow.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/files/aside_file.hpp"
#include "sweep/files/system_error.hpp"
#include "sweep/live/jobs.hpp"
#include "sweep/live/served.hpp"
#include "sweep/workers/process_start.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

struct ServeRequest {
    std::string place, control, base_path;
    std::vector<std::string> host_names;
    std::int64_t port = 8377;
    bool open = false;
};

volatile std::sig_atomic_t asked_to_end = 0;

/// Databases at a place: the file, or every database of the folder, by name. One that is damaged is a database, too.
class Databases {
public:
    explicit Databases(fs::path place) : place_(std::move(place)) {}

    [[nodiscard]] std::vector<fs::path> list() {
        std::error_code error;
        if (!fs::is_directory(place_, error)) return {place_};
        std::vector<fs::path> found;
        fs::directory_iterator entry(place_, error);
        for (; !error && entry != fs::directory_iterator(); entry.increment(error))
            if (entry->path().extension() == ".db" && is_database(*entry)) found.push_back(entry->path());
        std::ranges::sort(found);
        return found;
    }

private:
    struct Look {
        std::uintmax_t bytes = 0;
        fs::file_time_type written{};
        bool is_database = false;
    };

    /// Opens the file only if it has changed since it was no database.
    [[nodiscard]] bool is_database(const fs::directory_entry& entry) {
        std::error_code error;
        if (!entry.is_regular_file(error)) return false;
        const auto bytes = entry.file_size(error);
        const auto written = entry.last_write_time(error);
        auto [seen, fresh] = looks_.try_emplace(entry.path());
        auto& look = seen->second;
        if (!fresh && (look.is_database || (look.bytes == bytes && look.written == written))) return look.is_database;
        look = {bytes, written, opens(entry.path())};
        return look.is_database;
    }
    static bool opens(const fs::path& file) {
        try {
            const store::Store store(file, store::Store::Mode::read);
            return true;
        } catch (const campaign::InputError&) {
            return false;
        } catch (const SystemError&) {
            return true;
        }
    }

    fs::path place_;
    std::map<fs::path, Look> looks_;
};

std::vector<fs::path> require_databases(Databases& databases, const fs::path& place) {
    if (std::error_code error; !fs::is_directory(place, error)) (void)store::Store(place, store::Store::Mode::read);
    auto found = databases.list();
    if (found.empty())
        throw campaign::input_error("DB", place.string(), "the folder holds no database of grainsweep (*.db)");
    return found;
}

bool is_campaign(const fs::path& file) {
    try {
        (void)campaign::read_campaign(file);
        return true;
    } catch (const campaign::InputError&) {
        return false;
    } catch (const SystemError&) {
        return false;
    }
}

/// The file, or every campaign file of the folder, by name.
std::vector<fs::path> campaign_files_at(const fs::path& place) {
    if (fs::is_regular_file(place)) return {place};
    if (!fs::is_directory(place))
        throw campaign::input_error("--control", place.string(), "there is no such file or folder");
    std::vector<fs::path> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(place, error))
        if (entry.is_regular_file(error) && entry.path().extension() == ".json" && is_campaign(entry.path()))
            found.push_back(entry.path());
    if (found.empty())
        throw campaign::input_error("--control", place.string(),
                                    "the folder holds no campaign file that can be read (*.json)");
    std::ranges::sort(found);
    return found;
}

live::Proxy proxy_of(const ServeRequest& request) {
    live::Proxy proxy;
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~";
    for (const auto& name : request.host_names) {
        if (name.empty() || name.find_first_not_of(letters) != std::string::npos)
            throw campaign::input_error("--host-name", fmt::format("'{}'", name),
                                        "a name as in an address, without http:// and port");
        proxy.hosts.push_back(name);
    }
    if (request.base_path.empty()) return proxy;
    const auto& path = request.base_path;
    if (!path.starts_with('/') || path.find_first_not_of(std::string(letters) + "/%") != std::string::npos)
        throw campaign::input_error("--base-path", fmt::format("'{}'", path),
                                    "a path that begins with /, as in an address");
    proxy.base_path = path.ends_with('/') ? path : path + "/";
    return proxy;
}

/// Opens a browser by a file that only the user may read: other users see the arguments of a program.
void open_browser(const live::PrivateFolder& folder, const std::string& address) {
    const auto page = folder.path() / "open.html";
    files::AsideFile file(page);
    file.write(
        fmt::format("<!doctype html><meta charset=\"utf-8\"><meta name=\"referrer\" content=\"no-referrer\">"
                    "<meta http-equiv=\"refresh\" content=\"0; url={}\">\n",
                    address));
    file.take_place_unsynced();
    const auto opener = workers::find_program("xdg-open");
    std::error_code error;
    if (opener.empty() || workers::start_process({.argv = {opener, page.string()}}, error) < 0)
        std::cerr << "grainsweep: no browser could be opened (xdg-open)\n";
}

/// Hundreds of databases and readers need more descriptors than shells give.
void raise_descriptors() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 65536);
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

int serve(const ServeRequest& request, report::Format) {
    const fs::path place = request.place;
    const auto proxy = proxy_of(request);
    std::signal(SIGINT, [](int) { asked_to_end = 1; });
    std::signal(SIGTERM, [](int) { asked_to_end = 1; });
    raise_descriptors();
    Databases listed(place);
    auto databases = require_databases(listed, place);
    std::optional<live::Control> control;
    if (!request.control.empty()) control = live::Control{campaign_files_at(request.control)};
    const auto token = live::new_token();
    std::optional<live::Served> served;
    auto server = live::open_http_server(static_cast<std::uint16_t>(request.port),
                                         [&](const live::HttpQuestion& question) { return served->answer(question); });
    served.emplace(databases, control, token, proxy, [] { return asked_to_end != 0; });
    const auto address = fmt::format("http://127.0.0.1:{}{}?token={}", server->port(), proxy.base_path, token);
    std::cout << address << '\n' << std::flush;
    std::cerr << fmt::format("{} database{}; Ctrl-C ends the page, not the run\n", databases.size(),
                             databases.size() == 1 ? "" : "s");
    for (const auto& host : proxy.hosts)
        std::cerr << fmt::format("behind the proxy: https://{}{}?token={}\n", host, proxy.base_path, token);
    std::optional<live::PrivateFolder> opened;
    if (request.open) open_browser(opened.emplace(), address);
    for (auto last = std::chrono::steady_clock::now(); asked_to_end == 0;) {
        server->run(200ms);
        server->publish(served->look());
        if (std::chrono::steady_clock::now() - last < 2s) continue;
        last = std::chrono::steady_clock::now();
        auto found = listed.list();
        if (found == databases || found.empty()) continue;
        databases = std::move(found);
        served->follow(databases);
    }
    server.reset();
    if (!served->busy()) return 0;
    // A figure may take minutes, and nothing is written: the end does not wait for it.
    served->end_work();
    opened.reset();
    std::_Exit(0);
}

void declare_serve(Parser& parser, ServeRequest& request) {
    parser.add_option("DB", request.place, "database, or a folder of databases");
    parser.add_option("--port N", request.port, "port on this machine; 0: any that is free")
        ->check(whole_number(0, 65535))
        ->capture_default_str();
    parser.add_flag("--open", request.open, "opens the page in a browser");
    parser.add_option("--control FILE", request.control,
                      "lets the page stop a run and start this campaign file, or any of this folder");
    parser.add_option("--base-path PATH", request.base_path,
                      "path under which a proxy shows the page, for example /node/n7/8377/; the proxy may remove it");
    parser
        .add_option("--host-name NAME", request.host_names,
                    "further host name under which a proxy shows the page, may be repeated")
        ->allow_extra_args(false);
}

}  // namespace

std::vector<Command> serve_commands() {
    return {verbatim(
        command<ServeRequest>("serve", "shows databases in the browser while they grow", declare_serve, serve))};
}

}  // namespace grainsweep::cli
