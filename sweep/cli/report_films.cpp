#include "sweep/cli/report_films.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/cli/stored_case.hpp"
#include "sweep/report/film.hpp"
#include "sweep/report/film_choice.hpp"
#include "sweep/report/watch_page.hpp"
#include "sweep/workers/compute.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <iostream>
#include <optional>

namespace grainsweep::cli {
namespace {

constexpr std::int64_t frames = 36;
constexpr report::FilmLimits limits{.spheres = 8000, .bytes = 2'500'000, .columns = false};

}  // namespace

std::vector<report::PageFilm> films_of(const store::Store& store, std::int64_t count) {
    std::vector<report::PageFilm> films;
    const auto chosen = report::cases_to_watch(store, static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const auto& [campaign, id, says] = chosen[k];
        const auto leave_out = [&, &name = campaign](std::string_view why) {
            std::cerr << fmt::format("grainsweep: no film of case {} of {}: it {}\n", id.substr(0, 10), name, why);
        };
        std::cerr << fmt::format("film {} of {}: {}, case {} of {}\n", k + 1, chosen.size(), says, id.substr(0, 10),
                                 campaign);
        const campaign::Case stored = store.find_case(id).value();
        if (const auto why = why_not_again(stored); !why.empty()) {
            leave_out(why);
            continue;
        }
        const campaign::Case question = as_asked_today(stored);
        store.enter_files_of(question);
        report::Film film(limits);
        const workers::Camera camera{frames, [&film](const Scene& scene) { film.add(scene.snapshot(), scene.time()); },
                                     [&film](const std::vector<std::size_t>& pictures) { film.keep(pictures); }};
        NoArtefacts artefacts;
        const auto result = workers::compute(
            question, 1, artefacts, std::nullopt, [](const Scene&) { return true; }, camera);
        if (film.shows_anything())
            films.push_back({campaign, id, says, film.bytes(report::about_case(question, result.value()))});
        else
            leave_out(fmt::format("belongs to scene '{}', which shows no particles and no flow",
                                  shown_scene(question.scene)));
    }
    return films;
}

}  // namespace grainsweep::cli
