// serve: the report's page in the browser while its databases grow.
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/files/broken_world.hpp"
#include "sweep/live/served.hpp"
#include "sweep/workers/process_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

struct ServeRequest {
    std::string place, control;
    std::int64_t port = 8377;
    bool open = false;
};

volatile std::sig_atomic_t asked_to_end = 0;

bool is_database(const fs::path& file) {
    try {
        const store::Store store(file, store::Store::Mode::read);
        return true;
    } catch (const campaign::WrongQuestion&) {
        return false;
    } catch (const BrokenWorld&) {
        return false;
    }
}

/// The file, or every database of the folder, by name. Those that are `known` are not opened.
std::vector<fs::path> databases_at(const fs::path& place, const std::vector<fs::path>& known = {}) {
    std::error_code error;
    if (!fs::is_directory(place, error)) return {place};
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(place, error))
        if (entry.is_regular_file(error) && entry.path().extension() == ".db") found.push_back(entry.path());
    std::ranges::sort(found);
    std::erase_if(found,
                  [&](const fs::path& file) { return !std::ranges::binary_search(known, file) && !is_database(file); });
    return found;
}

std::vector<fs::path> require_databases(const fs::path& place) {
    auto found = databases_at(place);
    if (found.empty())
        throw campaign::wrong_question("DB", place.string(), "the folder holds no database of grainsweep (*.db)");
    return found;
}

bool is_campaign(const fs::path& file) {
    try {
        (void)campaign::read_campaign(file);
        return true;
    } catch (const campaign::WrongQuestion&) {
        return false;
    } catch (const BrokenWorld&) {
        return false;
    }
}

/// The file, or every campaign file of the folder, by name.
std::vector<fs::path> campaign_files_at(const fs::path& place) {
    if (fs::is_regular_file(place)) return {place};
    if (!fs::is_directory(place))
        throw campaign::wrong_question("--control", place.string(), "there is no such file or folder");
    std::vector<fs::path> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(place, error))
        if (entry.is_regular_file(error) && entry.path().extension() == ".json" && is_campaign(entry.path()))
            found.push_back(entry.path());
    if (found.empty())
        throw campaign::wrong_question("--control", place.string(),
                                       "the folder holds no campaign file that can be read (*.json)");
    std::ranges::sort(found);
    return found;
}

void open_browser(const std::string& address) {
    const auto opener = workers::find_program("xdg-open");
    std::error_code error;
    if (opener.empty() || workers::start_process({.argv = {opener, address}}, error) < 0)
        std::cerr << "grainsweep: no browser could be opened (xdg-open)\n";
}

int serve(const ServeRequest& request, report::Format) {
    const fs::path place = request.place;
    auto databases = require_databases(place);
    std::optional<live::Control> control;
    if (!request.control.empty()) control = live::Control{campaign_files_at(request.control)};
    const auto token = live::new_token();
    std::unique_ptr<live::Served> served;
    const auto server =
        live::open_http_server(static_cast<std::uint16_t>(request.port),
                               [&](const live::HttpQuestion& question) { return served->answer(question); });
    served = std::make_unique<live::Served>(databases, control, token);
    const auto address = fmt::format("http://127.0.0.1:{}/?token={}", server->port(), token);
    std::cout << address << '\n' << std::flush;
    std::cerr << fmt::format("{} database{}; Ctrl-C ends the page, not the run\n", databases.size(),
                             databases.size() == 1 ? "" : "s");
    if (request.open) open_browser(address);
    std::signal(SIGINT, [](int) { asked_to_end = 1; });
    std::signal(SIGTERM, [](int) { asked_to_end = 1; });
    auto listed = std::chrono::steady_clock::now();
    while (asked_to_end == 0) {
        server->run(200ms);
        server->publish(served->look());
        if (std::chrono::steady_clock::now() - listed < 2s) continue;
        listed = std::chrono::steady_clock::now();
        auto found = databases_at(place, databases);
        if (found == databases || found.empty()) continue;
        databases = std::move(found);
        try {
            served = std::make_unique<live::Served>(databases, control, token, served->work());
            server->publish(served->changed());
        } catch (const BrokenWorld& error) {  // of one of them; the others stay on the page as they are
            std::cerr << "grainsweep: " << error.what() << '\n';
        }
    }
    return 0;
}

void declare_serve(Parser& parser, ServeRequest& request) {
    parser.add_option("DB", request.place, "database, or a folder of databases");
    parser.add_option("--port N", request.port, "port on this machine; 0: any that is free")
        ->check(whole_number(0, 65535))
        ->capture_default_str();
    parser.add_flag("--open", request.open, "opens the page in a browser");
    parser.add_option("--control FILE", request.control,
                      "lets the page stop a run and start this campaign file, or any of this folder");
}

}  // namespace

std::vector<Command> serve_commands() {
    return {verbatim(
        command<ServeRequest>("serve", "shows databases in the browser while they grow", declare_serve, serve))};
}

}  // namespace grainsweep::cli
