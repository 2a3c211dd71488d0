#include "sweep/report/main_observables.hpp"

#include <algorithm>
#include <cstddef>

namespace grainsweep::report {
namespace {

constexpr std::size_t most_shown = 6, longest_meaning = 40;

}  // namespace

std::string in_few_words(std::string_view meaning) {
    const auto clause = meaning.substr(0, meaning.find_first_of(":;"));
    if (clause.size() <= longest_meaning) return std::string(clause);
    const auto space = clause.rfind(' ', longest_meaning);
    return std::string(clause.substr(0, space == std::string_view::npos ? longest_meaning : space)) + " ...";
}

std::vector<MainObservable> main_observables(const SceneInfo& scene) {
    if (!scene.main.empty()) return scene.main;
    std::vector<MainObservable> shown;
    for (const auto& observable : scene.observables) {
        if (observable.shape != Shape::scalar || observable.name.ends_with("_error")) continue;
        if (shown.size() == most_shown) break;
        shown.push_back({observable.name, in_few_words(observable.meaning)});
    }
    return shown;
}

std::vector<MainObservable> main_observables(const study::Responses& responses) {
    const auto scene = find_scene(responses.campaign.scene);
    auto shown = scene == nullptr ? std::vector<MainObservable>() : main_observables(*scene);
    std::erase_if(shown, [&](const MainObservable& one) { return !responses.measures(one.name); });
    const auto* deciding = responses.deciding_observable();
    if (deciding == nullptr && shown.empty()) deciding = responses.main_observable();
    if (deciding != nullptr && std::ranges::find(shown, deciding->name, &MainObservable::name) == shown.end())
        shown.insert(shown.begin(), {deciding->name, in_few_words(deciding->meaning)});
    return shown;
}

}  // namespace grainsweep::report
