// Observables that text output shows first, so that a reader need not know all of a scene.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/study/responses.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

/// Returns the main scalars of the scene. A scene that names none has its first six scalars, without standard errors.
[[nodiscard]] std::vector<MainObservable> main_observables(const SceneInfo& scene);

/// Returns the beginning of a meaning up to its first colon or semicolon, at most about 40 characters.
[[nodiscard]] std::string in_few_words(std::string_view meaning);

/// Returns the main observables of the campaign's scene that it measures. The observable that decides about the
/// campaign (its convergence rule or design) is included, and is first if the scene does not list it.
[[nodiscard]] std::vector<MainObservable> main_observables(const study::Responses& responses);

}  // namespace grainsweep::report
