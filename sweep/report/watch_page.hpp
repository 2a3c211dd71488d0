// Page of one case: its film and the player. It needs no network.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/report/film.hpp"

#include <string>

namespace grainsweep::report {

/// Returns the text beside the film: title, inputs and results with their units, and why a failed case ended.
[[nodiscard]] Json about_case(const campaign::Case& question, const campaign::CaseResult& result);

/// Returns the text beside the drawing of a machine (a scene) before it runs. `message`: what is missing from it.
[[nodiscard]] Json about_machine(const SceneInfo& machine, const Inputs& inputs, const std::string& message = {});

/// Returns the page. Throws std::invalid_argument for a film that shows nothing.
[[nodiscard]] std::string watch_page(const Film& film, const Json& about);

}  // namespace grainsweep::report
