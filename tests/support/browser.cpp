#include "tests/support/browser.hpp"

#include <regex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/support/process.hpp"

namespace grainsweep::tests {
namespace {

constexpr const char* program = "/usr/bin/chromium";

std::string unescaped(std::string text) {
    for (const auto& [entity, character] :
         {std::pair{"&quot;", "\""}, {"&lt;", "<"}, {"&gt;", ">"}, {"&nbsp;", " "}, {"&amp;", "&"}})
        for (std::size_t at = 0; (at = text.find(entity, at)) != std::string::npos; ++at)
            text.replace(at, std::string(entity).size(), character);
    return text;
}

}  // namespace

Browsed browse(const std::filesystem::path& page, const std::string& fragment, const std::filesystem::path& folder) {
    if (!std::filesystem::exists(program))
        throw std::runtime_error("the browser is missing: install chromium, as ./bootstrap.sh test does");
    Process browser(
        {program, "--headless", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--window-size=800,600", "--enable-logging=stderr",
         "--user-data-dir=" + (folder / "profile").string(), "--virtual-time-budget=60000", "--dump-dom",
         "file://" + page.string() + fragment},
        folder);
    const Ended ended = browser.wait();
    Browsed seen{ended.code, {}, ended.out, {}, ended.err};
    std::istringstream lines(ended.err);
    for (std::string line; std::getline(lines, line);)
        if (line.find(":CONSOLE") != std::string::npos &&
            line.find("GL Driver Message (OpenGL, Performance") == std::string::npos)
            seen.console.push_back(line);
    const std::string root = ended.out.substr(0, ended.out.find("<head>"));
    const std::regex attribute("data-([a-z]+)=\"([^\"]*)\"");
    for (std::sregex_iterator found(root.begin(), root.end(), attribute), end; found != end; ++found)
        seen.data[(*found)[1]] = unescaped((*found)[2]);
    return seen;
}

}  // namespace grainsweep::tests
