// Rehearsal: a scene with known answers and chosen misbehaviour, so that designs, statistics, scheduling
// and recovery can be proven without a simulation.
//
// Responses (x in [0,1]^16, unused factors have no influence):
//   sum          y = x1 + ... + x16
//   ishigami     y = sin z1 + 7 sin^2 z2 + 0.1 z3^4 sin z1, z = pi (2x - 1)       (Ishigami & Homma 1990)
//   g_function   y = prod (|4 x_j - 2| + a_j)/(1 + a_j), a = 0, 1, 4.5, 9, 99, 99, 99, 99 (Saltelli & Sobol 1995)
//   spreading_a  a smooth model of the mass flow rate under a blade; x1 ... x4 = friction 0.1-0.3, diameter
//                1-3 mm, gap 1-5 mm, speed 1.2-1.6 m/s: r = gap/diameter; 0 for r <= 1, else
//                0.62 (1 - (mu - 0.2)/2)(1 - (v - 1.4)/4)(1 - exp(-(r - 1)/r0)), r0 = 0.8 (1 + 0.8 (mu - 0.2))
//   spreading_b  the same, but zero for r <= 1.25 (a jump)
// plus noise: y (1 + noise (2u - 1)), u addressed by the case's seed.
#include "solver/bytes.hpp"
#include "solver/scenes/catalogue.hpp"
#include "stats/random.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>

namespace grainsweep {
namespace {

constexpr std::size_t dimensions = 16;
using Point = std::array<double, dimensions>;

double sum(const Point& x) {
    double total = 0;
    for (const double xi : x) total += xi;
    return total;
}

double ishigami(const Point& x) {
    const auto z = [&](std::size_t j) { return std::numbers::pi * (2 * x[j] - 1); };
    const double s2 = std::sin(z(1));
    const double z3 = z(2);
    return std::sin(z(0)) + 7 * s2 * s2 + 0.1 * z3 * z3 * z3 * z3 * std::sin(z(0));
}

double g_function(const Point& x) {
    constexpr std::array a = {0.0, 1.0, 4.5, 9.0, 99.0, 99.0, 99.0, 99.0};
    double product = 1;
    for (std::size_t j = 0; j < a.size(); ++j) product *= (std::abs(4 * x[j] - 2) + a[j]) / (1 + a[j]);
    return product;
}

double spreading(const Point& x, double threshold) {
    const double mu = 0.1 + 0.2 * x[0];
    const double diameter = 1 + 2 * x[1];
    const double gap = 1 + 4 * x[2];
    const double speed = 1.2 + 0.4 * x[3];
    const double r = gap / diameter;
    if (r <= threshold) return 0;
    const double r0 = 0.8 * (1 + 0.8 * (mu - 0.2));
    return 0.62 * (1 - 0.5 * (mu - 0.2)) * (1 - 0.25 * (speed - 1.4)) * (1 - std::exp(-(r - 1) / r0));
}

double respond(const std::string& response, const Point& x) {
    if (response == "ishigami") return ishigami(x);
    if (response == "g_function") return g_function(x);
    if (response == "spreading_a") return spreading(x, 1.0);
    if (response == "spreading_b") return spreading(x, 1.25);
    return sum(x);
}

class Rehearsal final : public Scene {
public:
    Rehearsal(const Inputs& inputs, std::uint64_t seed) : seed_(seed) {
        for (std::size_t j = 0; j < dimensions; ++j) x_[j] = std::get<double>(inputs.at("x" + std::to_string(j + 1)));
        response_ = std::get<std::string>(inputs.at("response"));
        noise_ = std::get<double>(inputs.at("noise"));
        wait_ = std::get<double>(inputs.at("wait_seconds"));
        behaviour_ = std::get<std::string>(inputs.at("behaviour"));
    }

    void advance(double until) override {
        if (behaviour_ == "crash") std::raise(SIGKILL);
        while (behaviour_ == "hang") std::this_thread::sleep_for(std::chrono::seconds(1));
        const double target = std::min(until, wait_);
        while (time_ < target) {
            const double slice = std::min(0.01, target - time_);
            std::this_thread::sleep_for(std::chrono::duration<double>(slice));
            time_ += slice;
        }
        done_ = time_ >= wait_;
    }

    void observe(Observations& into) const override {
        double y = respond(response_, x_);
        if (noise_ > 0) y *= 1 + noise_ * (2 * stats::Stream(seed_, 0).uniform(0) - 1);
        into.scalars["y"] = y;
        auto& series = into.series["y_series"];
        const std::size_t length = behaviour_ == "huge" ? 20'000 : 0;
        for (std::size_t k = 0; k < length; ++k) {
            const double share = static_cast<double>(k + 1) / static_cast<double>(length);
            series.push_back({.time = share, .value = y * share});
        }
    }

    [[nodiscard]] double time() const override { return time_; }
    [[nodiscard]] bool finished() const override { return done_; }
    [[nodiscard]] double progress() const override { return wait_ > 0 ? time_ / wait_ : (done_ ? 1.0 : 0.0); }
    [[nodiscard]] Health health() const override {
        if (behaviour_ == "unstable") return {"asked to be unstable, everywhere, at once"};
        return {};
    }

    void save(Bytes& into) const override {
        into.clear();
        append_bytes(into, time_);
    }
    void restore(std::span<const std::byte> from) override {
        if (from.size() != sizeof time_) throw std::invalid_argument("checkpoint of another scene");
        double saved = 0;
        take_bytes(from, saved);
        if (!(saved >= 0 && saved <= wait_)) throw std::invalid_argument("checkpoint holds a time that no state has");
        time_ = saved;
    }

private:
    std::uint64_t seed_;
    Point x_{};
    std::string response_, behaviour_;
    double noise_ = 0, wait_ = 0, time_ = 0;
    bool done_ = false;
};

ParameterSpec coordinate(std::size_t j) {
    return {.name = "x" + std::to_string(j),
            .unit = "1",
            .meaning = "coordinate " + std::to_string(j) + " of the response",
            .default_value = 0.5,
            .bounds = Interval{0, 1},
            .relevant_if = {}};
}

}  // namespace

SceneInfo rehearsal_scene() {
    SceneInfo info;
    info.name = "rehearsal";
    info.summary = "formulas with known answers, and cases that fail on request: try a campaign without simulating";
    info.revision = 1;
    for (std::size_t j = 1; j <= dimensions; ++j) info.parameters.push_back(coordinate(j));
    info.parameters.push_back({"response",
                               "",
                               "which known function answers",
                               std::string("sum"),
                               Words{{"sum", "ishigami", "g_function", "spreading_a", "spreading_b"}},
                               {}});
    info.parameters.push_back({"noise", "1", "relative amplitude of a seeded disturbance", 0.0, Interval{0, 1}, {}});
    info.parameters.push_back({"wait_seconds", "s", "time the case takes", 0.0, Interval{0, 86400}, {}});
    info.parameters.push_back({"behaviour",
                               "",
                               "what the case does instead of answering",
                               std::string("normal"),
                               Words{{"normal", "crash", "hang", "unstable", "huge"}},
                               {}});
    info.parameters.push_back({"behave_attempts",
                               "1",
                               "only the first so many attempts misbehave (0: all of them)",
                               std::int64_t{0},
                               Interval{0, 1000},
                               {{"behaviour", Relevance::Condition::is_word, {"crash", "hang", "unstable", "huge"}}}});
    info.observables = {
        {"y", "1", "the response", Shape::scalar},
        {"y_series", "1", "y growing linearly in time ('huge' only)", Shape::series, "share of the case"}};
    info.maker = [](const Inputs& inputs, std::uint64_t seed, Artefacts&, const Files&) -> std::unique_ptr<Scene> {
        return std::make_unique<Rehearsal>(inputs, seed);
    };
    info.estimate_cost = [](const Inputs& inputs, const Files&) {
        return CostEstimate{1e-5 + std::get<double>(inputs.at("wait_seconds")), 0, 0};
    };
    info.on_attempt = [](Inputs inputs, std::int64_t attempt) {
        const auto misbehaving = std::get<std::int64_t>(inputs.at("behave_attempts"));
        if (misbehaving > 0 && attempt > misbehaving) inputs["behaviour"] = std::string("normal");
        return inputs;
    };
    return info;
}

}  // namespace grainsweep
