// Import of sizes that is refused.
#pragma once

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/powder_export.hpp"

#include <string>

namespace grainsweep::tests {

/// Returns the sentence by which an export is refused, or "accepted".
[[nodiscard]] inline std::string refusal(const std::string& bytes, const campaign::ExportChoices& choices = {}) {
    try {
        (void)campaign::import_sizes(bytes, choices);
    } catch (const campaign::InputError& wrong) {
        return wrong.what();
    }
    return "accepted";
}

}  // namespace grainsweep::tests
