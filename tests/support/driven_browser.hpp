// Headless Chromium that a test drives through the DevTools protocol (--remote-debugging-pipe) while the page lives.
#pragma once

#include "tests/support/process.hpp"

#include <sys/types.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests {

class DrivenBrowser {
public:
    struct Screen {
        int width = 1000, height = 900;
        bool dark = false;
    };
    /// Opens the page. `folder` takes the profile. Throws std::runtime_error where the browser is not there.
    DrivenBrowser(const std::string& address, const Folder& folder, const Screen& screen);
    ~DrivenBrowser();
    DrivenBrowser(const DrivenBrowser&) = delete;
    DrivenBrowser& operator=(const DrivenBrowser&) = delete;

    /// The value of an expression, awaited where it is a promise. Throws std::runtime_error where it throws.
    nlohmann::json value(const std::string& expression);
    /// Waits until the expression is true, which it is not where it throws; false where it is not for a minute.
    bool until(const std::string& expression);
    /// A change of the screen: width, and dark or light.
    void show(const Screen& screen);
    /// Errors and warnings of the page's console so far.
    [[nodiscard]] const std::vector<std::string>& complaints() const { return complaints_; }

private:
    nlohmann::json call(const std::string& method, const nlohmann::json& parameters);
    nlohmann::json next_message();
    void take_note(const nlohmann::json& message);

    pid_t process_ = -1;
    int to_ = -1, from_ = -1, last_ = 0;
    std::string buffer_, session_;
    std::vector<std::string> complaints_;
};

}  // namespace grainsweep::tests
