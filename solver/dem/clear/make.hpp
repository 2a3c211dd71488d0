// Chooses the instantiation of the clear engine that a case needs.
#pragma once

#include "solver/dem/engine.hpp"

namespace grainsweep::dem::clear {

/// A valid setup (make_engine has checked it) -> an engine at step 0.
[[nodiscard]] std::unique_ptr<Engine> make_clear_engine(const Setup& setup, const Method& method);

}  // namespace grainsweep::dem::clear
