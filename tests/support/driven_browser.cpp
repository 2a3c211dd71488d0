#include "tests/support/driven_browser.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace grainsweep::tests {
namespace {

using Json = nlohmann::json;
constexpr const char* chromium = "/usr/bin/chromium";

}  // namespace

DrivenBrowser::DrivenBrowser(const std::string& address, const Folder& folder, const Screen& screen) {
    if (!std::filesystem::exists(chromium))
        throw std::runtime_error("the browser is missing: install chromium, as ./bootstrap.sh test does");
    std::array<int, 2> in{}, out{};
    if (::pipe2(in.data(), O_CLOEXEC) != 0 || ::pipe2(out.data(), O_CLOEXEC) != 0)
        throw std::runtime_error("no pipe for the browser");
    const std::string profile = "--user-data-dir=" + (folder / "driven_profile").string();
    process_ = ::fork();
    if (process_ == 0) {
        ::setpgid(0, 0);
        const int a = ::fcntl(in[0], F_DUPFD, 10), b = ::fcntl(out[1], F_DUPFD, 10);
        ::dup2(a, 3);
        ::dup2(b, 4);
        const int nowhere = ::open("/dev/null", O_RDWR);
        for (int stream = 0; stream < 3; ++stream) ::dup2(nowhere, stream);
        ::execl(chromium, chromium, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic",
                "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
                "--remote-debugging-pipe", profile.c_str(), nullptr);
        ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    to_ = in[1];
    from_ = out[0];
    const auto target = call("Target.createTarget", {{"url", "about:blank"}})["targetId"];
    session_ = call("Target.attachToTarget", {{"targetId", target}, {"flatten", true}})["sessionId"];
    for (const auto* part : {"Page.enable", "Runtime.enable", "Log.enable"}) call(part, Json::object());
    show(screen);
    call("Page.navigate", {{"url", address}});
}

DrivenBrowser::~DrivenBrowser() {
    ::kill(-process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    ::close(to_);
    ::close(from_);
}

Json DrivenBrowser::next_message() {
    constexpr int most_ms = 60000;
    for (auto end = buffer_.find('\0'); end == std::string::npos; end = buffer_.find('\0')) {
        pollfd ready{from_, POLLIN, 0};
        std::array<char, 65536> bytes{};
        const auto count = ::poll(&ready, 1, most_ms) > 0 ? ::read(from_, bytes.data(), bytes.size()) : 0;
        if (count <= 0) throw std::runtime_error("the browser does not answer");
        buffer_.append(bytes.data(), static_cast<std::size_t>(count));
    }
    const auto end = buffer_.find('\0');
    auto message = Json::parse(buffer_.substr(0, end));
    buffer_.erase(0, end + 1);
    return message;
}

void DrivenBrowser::take_note(const Json& message) {
    const auto method = message.value("method", "");
    const auto& about = message.contains("params") ? message["params"] : message;
    if (method == "Runtime.exceptionThrown") complaints_.push_back(about["exceptionDetails"].dump());
    if (method == "Runtime.consoleAPICalled" && (about["type"] == "error" || about["type"] == "warning"))
        complaints_.push_back(about["args"].dump());
    if (method == "Log.entryAdded" && (about["entry"]["level"] == "error" || about["entry"]["level"] == "warning"))
        complaints_.push_back(about["entry"]["text"].get<std::string>());
}

Json DrivenBrowser::call(const std::string& method, const Json& parameters) {
    Json request = {{"id", ++last_}, {"method", method}, {"params", parameters}};
    if (!session_.empty()) request["sessionId"] = session_;
    const auto text = request.dump();
    if (::write(to_, text.c_str(), text.size() + 1) != static_cast<ssize_t>(text.size() + 1))
        throw std::runtime_error("the browser takes no command");
    for (;;) {
        const auto message = next_message();
        take_note(message);
        if (message.value("id", 0) != last_) continue;
        if (message.contains("error")) throw std::runtime_error(method + ": " + message["error"].dump());
        return message["result"];
    }
}

Json DrivenBrowser::value(const std::string& expression) {
    const auto result =
        call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
    if (result.contains("exceptionDetails")) throw std::runtime_error(result["exceptionDetails"].dump());
    return result["result"].value("value", Json());
}

bool DrivenBrowser::until(const std::string& expression) {
    const auto last = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < last) {
        if (value("(() => { try { return Boolean(" + expression + "); } catch { return false; } })()") == true)
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
}

void DrivenBrowser::show(const Screen& screen) {
    call(
        "Emulation.setDeviceMetricsOverride",
        {{"width", screen.width}, {"height", screen.height}, {"deviceScaleFactor", 1}, {"mobile", screen.width < 600}});
    call("Emulation.setEmulatedMedia",
         {{"features", Json::array({{{"name", "prefers-color-scheme"}, {"value", screen.dark ? "dark" : "light"}}})}});
}

}  // namespace grainsweep::tests
