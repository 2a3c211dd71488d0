#include "sweep/workers/compute.hpp"

#include "sweep/campaign/file_contents.hpp"
#include "sweep/workers/thread_choice.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace grainsweep::workers {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

double processor_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Slices of about this length: short enough to answer a stop at once, long enough to cost nothing.
constexpr double slice_seconds = 0.1;
// In the scene's time, whose scale is unknown: shorter than any step, then it adapts to the clock.
constexpr double first_slice = 1e-9;
// Shorter slices do not tell how fast threads are.
constexpr double least_timed_seconds = 0.02;

/// Takes the pictures of a camera: of the preparation before the focus, then of the main part.
class Shutter {
public:
    Shutter(const Camera& camera, const Scene& scene) : camera_(camera) {
        if (camera_.frames > 0) begin_part(scene, 0);
    }
    /// Returns the time of the next picture, or of the focus.
    [[nodiscard]] double next() const {
        if (camera_.frames == 0 || !foreseen_ || !(spacing_ > 0)) return std::numeric_limits<double>::infinity();
        const double moment = begin_ + spacing_ * static_cast<double>(taken_);
        if (preparing_) return std::min(moment, focus_);
        if (!(period_ > 0 && period_ <= spacing_)) return moment;
        // Slightly early: the scene's own step that ends there must not be missed by rounding.
        return std::round(moment / period_) * period_ * (1 - 1e-9);
    }
    void look(const Scene& scene) {
        if (camera_.frames == 0) return;
        if (!foreseen_ && scene.progress() > 0) foresee(scene);
        if (preparing_) focus_ = scene.picture_focus();
        if (scene.time() < next()) return;
        if (preparing_ && scene.time() >= focus_) {
            preparing_ = false;
            if (finer_ == 1) preparation_ = static_cast<std::int64_t>(shot_at_.size());
            begin_part(scene, camera_.frames - preparation_);
            spacing_ = (std::max(end_, begin_) - begin_) / static_cast<double>(std::max<std::int64_t>(1, wanted_ - 1)) /
                       finer_;
            return;
        }
        shoot(scene);
        if (finer_ > 1 && taken_ > 2 * wanted_) halve();
        while (next() <= scene.time()) ++taken_;
    }
    void last(const Scene& scene) {
        if (camera_.frames == 0) return;
        if (scene.time() > shot_at_.back()) shoot(scene);
        if (finer_ == 1) return;
        // What the main part leaves, because it was short, the preparation gets.
        const std::size_t first = first_, main = shot_at_.size() - first;
        const auto all = static_cast<std::size_t>(camera_.frames), before = static_cast<std::size_t>(preparation_);
        const std::size_t of_main = std::min(main, all - std::min(before, first));
        std::vector<std::size_t> places = evenly(0, first, std::min(first, all - of_main));
        std::ranges::copy(evenly(first, main, of_main), std::back_inserter(places));
        camera_.keep(places);
    }

private:
    static constexpr double most_preparation = 0.25;  // of the pictures, at most
    static constexpr double finer_of_early = 16;

    void foresee(const Scene& scene) {
        foreseen_ = true;
        period_ = scene.picture_period();
        finer_ = scene.may_end_early() && camera_.keep ? finer_of_early : 1;
        end_ = std::max(scene.time() / scene.progress(), scene.time());
        focus_ = std::clamp(scene.picture_focus(), begin_, end_);
        const double share = end_ > begin_ ? std::min(most_preparation, (focus_ - begin_) / (end_ - begin_)) : 0;
        preparation_ = wanted_ = std::llround(share * static_cast<double>(camera_.frames - 1));
        preparing_ = wanted_ > 0;
        if (preparing_ && finer_ > 1) wanted_ = camera_.frames;
        const double part_end = preparing_ ? focus_ : end_;
        if (!preparing_) wanted_ = camera_.frames - 1;
        spacing_ = (part_end - begin_) / static_cast<double>(wanted_) / finer_;
    }
    void begin_part(const Scene& scene, std::int64_t wanted) {
        first_ = shot_at_.size();
        begin_ = scene.time();
        wanted_ = wanted;
        taken_ = 0;
        shoot(scene);
    }
    void shoot(const Scene& scene) {
        camera_.shoot(scene);
        shot_at_.push_back(scene.time());
        ++taken_;
    }
    void halve() {
        std::vector<std::size_t> places;
        for (std::size_t k = first_; k < shot_at_.size(); k += 2) places.push_back(k);
        keep(places);
        spacing_ *= 2;
        taken_ = static_cast<std::int64_t>(places.size());
    }
    /// Returns so many of `there` places from `begin` on, the first and the last included.
    static std::vector<std::size_t> evenly(std::size_t begin, std::size_t there, std::size_t wanted) {
        std::vector<std::size_t> places;
        for (std::size_t k = 0; k < wanted; ++k)
            places.push_back(begin + (wanted < 2 ? there - 1 : (k * (there - 1) + (wanted - 1) / 2) / (wanted - 1)));
        return places;
    }
    /// Keeps the earlier parts, and of the present one the pictures at these places.
    void keep(const std::vector<std::size_t>& of_part) {
        std::vector<std::size_t> places(first_);
        std::iota(places.begin(), places.end(), std::size_t{0});
        places.insert(places.end(), of_part.begin(), of_part.end());
        camera_.keep(places);
        std::vector<double> kept;
        for (const std::size_t k : places) kept.push_back(shot_at_[k]);
        shot_at_ = std::move(kept);
    }

    const Camera& camera_;
    double begin_ = 0, spacing_ = 0;  // of the present part
    double focus_ = 0, end_ = 0, period_ = 0;
    double finer_ = 1;  // spacing wanted divided by the first one
    bool foreseen_ = false, preparing_ = false;
    std::int64_t preparation_ = 0;         // pictures before the focus, at most
    std::int64_t wanted_ = 0, taken_ = 0;  // pictures of the present part
    std::size_t first_ = 0;                // its first picture
    std::vector<double> shot_at_;          // of all pictures kept, s
};

/// Of something over time.
class Mean {
public:
    void add(double value, double seconds) {
        sum_ += value * seconds;
        seconds_ += seconds;
    }
    [[nodiscard]] double value() const {
        return seconds_ > 0 ? sum_ / seconds_ : std::numeric_limits<double>::quiet_NaN();
    }

private:
    double sum_ = 0, seconds_ = 0;
};

/// Advances until the scene is over, fails or is given up; true when it is over. `used`: threads.
bool drive(Scene& scene, const Watch& watch, const Camera& camera, Mean& used) {
    Shutter shutter(camera, scene);
    ThreadChoice threads;
    double slice = first_slice;
    bool awaited = camera.at_moment != nullptr;
    const auto look_at_moment = [&] {
        if (awaited) camera.at_moment(scene);
        awaited = false;
    };
    while (!scene.finished() && scene.health().stable()) {
        const auto start = Clock::now();
        const double next = std::min(shutter.next(), awaited ? camera.moment : std::numeric_limits<double>::infinity());
        const bool cut = next < scene.time() + slice;
        const int count = scene.use_threads(threads.next(allowed_threads()));
        const double work = scene.particle_steps();
        scene.advance(cut ? next : scene.time() + slice);
        const double took = std::max(seconds_since(start), 1e-6);
        if (took >= least_timed_seconds) threads.note(scene.particle_steps() - work, took);
        used.add(count, took);
        if (!cut) slice *= std::clamp(slice_seconds / took, 0.25, 4.0);
        shutter.look(scene);
        if (scene.time() >= camera.moment) look_at_moment();
        if (!watch(scene)) return false;
    }
    shutter.last(scene);
    look_at_moment();
    return true;
}

bool all_finite(const Observations& observations) {
    const auto infinite = [](double x) { return std::isinf(x); };
    for (const auto& [name, value] : observations.scalars) {
        if (infinite(value)) return false;
    }
    for (const auto& [name, samples] : observations.series) {
        if (std::ranges::any_of(samples, infinite, &Sample::value)) return false;
    }
    return true;
}

}  // namespace

std::optional<campaign::CaseResult> compute(const campaign::Case& question, std::int64_t attempt, Artefacts& artefacts,
                                            const std::optional<Bytes>& resume, const Watch& watch,
                                            const Camera& camera) {
    const auto start = Clock::now();
    const double processor_start = processor_seconds();
    campaign::CaseResult result;
    std::string remark;  // on a case that is completed all the same
    result.attempt = {question.id, attempt};
    const auto close = [&](campaign::Outcome outcome, std::string message) {
        result.outcome = outcome;
        result.message = std::move(message);
        result.cost.wall_seconds = seconds_since(start);
        result.cost.cpu_seconds = processor_seconds() - processor_start;
        return result;
    };

    const auto info = find_scene(question.scene);
    if (info == nullptr || info->revision != question.revision) {
        return close(campaign::Outcome::rejected,
                     fmt::format("this build has no scene '{}' of revision {}", question.scene, question.revision));
    }
    auto read = campaign::files_named(question.inputs);
    if (auto* const why = std::get_if<std::string>(&read)) return close(campaign::Outcome::rejected, std::move(*why));
    const Files& files = std::get<Files>(read);
    const Inputs inputs = info->on_attempt ? info->on_attempt(question.inputs, attempt) : question.inputs;
    try {
        if (auto proven = info->proven_answer ? info->proven_answer(inputs) : std::nullopt) {
            result.observations = std::move(proven->observations);
            return close(campaign::Outcome::skipped, proven->reason);
        }
        auto scene = info->make(inputs, question.seed, artefacts, files);
        if (resume) {
            try {
                scene->restore(*resume);
            } catch (const std::invalid_argument& error) {
                scene = info->make(inputs, question.seed, artefacts, files);
                remark = fmt::format("computed from the beginning: its checkpoint was refused ({})", error.what());
            }
        }
        Mean used;
        if (!drive(*scene, watch, camera, used)) return std::nullopt;
        result.cost.threads = used.value();
        result.cost.particle_steps = scene->particle_steps();
        result.cost.phases = scene->phase_seconds();
        if (const Health health = scene->health(); !health.stable()) {
            return close(campaign::Outcome::unstable, health.reason);
        }
        scene->observe(result.observations);
        if (std::string own = scene->remark(); !own.empty()) remark += (remark.empty() ? "" : "; ") + std::move(own);
    } catch (const std::invalid_argument& error) {
        return close(campaign::Outcome::rejected, error.what());
    }
    if (const auto name = campaign::undeclared(result.observations, info->observables)) {
        result.observations = {};
        return close(campaign::Outcome::rejected,
                     fmt::format("it measured '{}', which its scene does not declare so", *name));
    }
    if (!all_finite(result.observations)) {
        result.observations = {};
        return close(campaign::Outcome::unstable, "an observable became infinite");
    }
    return close(campaign::Outcome::completed, remark);
}

}  // namespace grainsweep::workers
