// Wrong machine files: the small sound one after one change, and the sentence that refuses it.
#pragma once

#include "tests/support/machines.hpp"

#include <string>

namespace grainsweep::tests {

/// What is changed: the value at a JSON pointer, "REMOVE", or with the path "PATCH" a JSON patch. The sentence begins
/// with the place (of a case that is rejected: none) and contains the rule.
struct WrongMachine {
    const char *path, *value, *place, *rule;
};

void expect_refusal(const WrongMachine& wrong);
/// The sentence that refuses a machine, when it is read or when its default case begins; "accepted" where none does.
[[nodiscard]] std::string refusal_of(const nlohmann::json& document, const Inputs& chosen = {});

}  // namespace grainsweep::tests
