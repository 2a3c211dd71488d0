// A page in a real browser without a window (Chromium, graphics in software).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace grainsweep::tests {

struct Browsed {
    int code = -1;
    std::map<std::string, std::string> data;  ///< the data- attributes of the root element
    std::string document;                     ///< as the page left it
    /// What reached its console, a line each; notes on performance left out.
    std::vector<std::string> console;
    std::string said;  ///< all that the browser said
};

/// Opens the page, lets its scripts run to their end and looks at what they left. Throws std::runtime_error where the
/// browser is not there.
[[nodiscard]] Browsed browse(const std::filesystem::path& page, const std::string& fragment,
                             const std::filesystem::path& folder);

}  // namespace grainsweep::tests
