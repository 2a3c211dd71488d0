// What the program writes, to be looked into.
#pragma once

#include "sweep/report/document.hpp"

#include <nlohmann/json.hpp>

#include <sstream>
#include <string>

namespace grainsweep::tests {

inline nlohmann::ordered_json parsed(const report::Json& json) {
    return nlohmann::ordered_json::parse(json.text());
}

inline std::string text_of(const report::Document& document) {
    std::ostringstream text;
    report::write(text, document, report::Format::text);
    return text.str();
}

}  // namespace grainsweep::tests
