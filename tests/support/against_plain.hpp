// Any setup in the mixed-precision engine against the law written plainly, path by path.
#pragma once

#include <string>
#include <vector>

#include "solver/dem/engine.hpp"
#include "tests/support/plain_dem.hpp"

namespace grainsweep::tests {

struct Question {
    std::string name;
    dem::Setup setup;
    std::int64_t steps;
};

[[nodiscard]] std::string path_name(dem::Method::Path path);
/// Instruction paths that this processor has.
[[nodiscard]] std::vector<dem::Method::Path> paths();
/// The particles of the plain calculation that are in `like`.
[[nodiscard]] dem::State plain_state(const PlainDem& plain, const dem::State& like);

/// Collisions multiply differences, so the tolerance is measured: the plain calculation is repeated with every start
/// position moved by up to 1e-7 diameters (two units of single precision), and the engine may differ from the plain one
/// by ten times what that grows to. A wrong convention (torque arm, order of damping and limit) differs by 1e-2.
void compare_with_plain(const Question& q);

}  // namespace grainsweep::tests
