// Reads the events of `grainsweep serve` as they come, as its page does.
#pragma once

#include "tests/support/live_server.hpp"

#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

namespace grainsweep::tests {

class EventReader {
public:
    explicit EventReader(Connected stream) : stream_(std::move(stream)) {}

    /// Reads on until the condition holds. Returns false if it does not within this time, or the stream ends.
    template <class Condition>
    bool until(Condition holds, std::chrono::seconds at_most = std::chrono::seconds(60)) {
        using Clock = std::chrono::steady_clock;
        for (const auto last = Clock::now() + at_most; !holds();) {
            const auto more = stream_.receive(std::chrono::milliseconds(20));
            if (!more || Clock::now() > last) return false;
            text_ += *more;
            for (auto end = text_.find("\n\n"); end != std::string::npos; end = text_.find("\n\n")) {
                take(text_.substr(0, end));
                text_.erase(0, end + 2);
            }
        }
        return true;
    }

    std::multiset<std::string> cases;  ///< ids of cases with a result
    std::set<std::string> settled;     ///< of these, with another outcome than abandoned
    nlohmann::json now;                ///< the last of its kind
    int pages = 0;

private:
    void take(const std::string& event) {
        const auto kind = [&](const char* name) {
            return event.find(std::string("event: ") + name) != std::string::npos;
        };
        if (kind("page")) ++pages;
        if (kind("now")) now = data_of(event);
        if (!kind("results")) return;
        const auto data = data_of(event);
        for (const auto& one : data["results"]) {
            cases.insert(one["case"].get<std::string>());
            if (one["outcome"] != "abandoned") settled.insert(one["case"].get<std::string>());
        }
    }
    static nlohmann::json data_of(const std::string& event) {
        return nlohmann::json::parse(event.substr(event.find("data: ") + 6));
    }

    Connected stream_;
    std::string text_;
};

}  // namespace grainsweep::tests
