#include "stats/posterior.hpp"

#include "stats/random.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grainsweep::stats {
namespace {

constexpr double impossible = -std::numeric_limits<double>::infinity();
constexpr double stretch = 2;         // a of Goodman & Weare
constexpr double start_reach = 0.01;  // of the box
constexpr double sokal_window = 5;

/// Purposes of the draws of one walker at one step.
enum Draw : std::uint64_t { partner, factor, acceptance, first_coordinate };

/// Uniform draws addressed by (seed, step, walker, purpose).
struct Draws {
    std::uint64_t seed;
    [[nodiscard]] double uniform(std::size_t step, std::size_t walker, std::uint64_t purpose) const {
        return to_unit(splitmix64(bits_at(seed, step, walker) ^ (purpose * 0xD1342543DE82EF95ULL)));
    }
};

struct Ensemble {
    std::size_t dimensions;
    std::vector<double> points;
    std::vector<double> density;
    [[nodiscard]] std::span<double> at(std::size_t w) { return std::span(points).subspan(w * dimensions, dimensions); }
};

std::vector<double> densities(const LogDensity& density, const std::vector<double>& points, std::size_t d) {
    auto values = density({points, d});
    if (values.size() * d != points.size()) throw std::invalid_argument("posterior: not one density for each point");
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto row = std::span(points).subspan(i * d, d);
        const bool inside = std::ranges::all_of(row, [](double x) { return x >= 0 && x <= 1; });
        if (!inside || std::isnan(values[i])) values[i] = impossible;
    }
    return values;
}

/// Points outside the box are never asked: the density sees them moved onto it and their answer is thrown away.
std::vector<double> onto_box(std::vector<double> points) {
    for (double& x : points) x = std::clamp(x, 0.0, 1.0);
    return points;
}

Ensemble begin(const LogDensity& density, Rows starts, std::size_t walkers, const Draws& draws) {
    const std::size_t d = starts.dimensions;
    const std::vector<double> given(starts.values.begin(), starts.values.end());
    const auto levels = densities(density, given, d);
    std::vector<std::size_t> possible;
    for (std::size_t i = 0; i < levels.size(); ++i)
        if (levels[i] > impossible) possible.push_back(i);
    if (possible.empty()) throw std::invalid_argument("posterior: no starting point is possible");
    Ensemble e{d, std::vector<double>(walkers * d), {}};
    for (std::size_t w = 0; w < walkers; ++w)
        for (std::size_t j = 0; j < d; ++j)
            e.at(w)[j] = std::clamp(starts.row(possible[w % possible.size()])[j] +
                                        start_reach * (2 * draws.uniform(0, w, first_coordinate + j) - 1),
                                    0.0, 1.0);
    e.density = densities(density, e.points, d);
    for (std::size_t w = 0; w < walkers; ++w) {
        if (e.density[w] > impossible) continue;
        const std::size_t from = possible[w % possible.size()];
        std::ranges::copy(starts.row(from), e.at(w).begin());
        e.density[w] = levels[from];
    }
    return e;
}

/// Moves the walkers first ... first + count - 1 against the others, which lie in one stretch beside them.
std::size_t move_half(Ensemble& e, const LogDensity& density, std::size_t step, bool second, const Draws& draws) {
    const std::size_t d = e.dimensions, half = e.density.size() / 2;
    const std::size_t first = second ? half : 0, others = second ? 0 : half;
    std::vector<double> proposed(half * d), weights(half);
    for (std::size_t w = 0; w < half; ++w) {
        const double u = draws.uniform(step, first + w, factor);
        const double q = std::pow(1 + (stretch - 1) * u, 2) / stretch;
        const auto drawn =
            static_cast<std::size_t>(draws.uniform(step, first + w, partner) * static_cast<double>(half));
        const auto y = e.at(others + std::min(drawn, half - 1));
        const auto x = e.at(first + w);
        for (std::size_t j = 0; j < d; ++j) proposed[w * d + j] = y[j] + q * (x[j] - y[j]);
        weights[w] = static_cast<double>(d - 1) * std::log(q);
    }
    auto levels = densities(density, onto_box(proposed), d);
    std::size_t accepted = 0;
    for (std::size_t w = 0; w < half; ++w) {
        const auto row = std::span(proposed).subspan(w * d, d);
        if (!std::ranges::all_of(row, [](double x) { return x >= 0 && x <= 1; })) continue;
        const double u = draws.uniform(step, first + w, acceptance);
        if (!(std::log(1 - u) < weights[w] + levels[w] - e.density[first + w])) continue;
        std::ranges::copy(row, e.at(first + w).begin());
        e.density[first + w] = levels[w];
        ++accepted;
    }
    return accepted;
}

/// Paths of one coordinate: path[t * walkers + w].
struct Paths {
    std::vector<double> values;
    std::size_t walkers, steps;
    [[nodiscard]] double at(std::size_t t, std::size_t w) const { return values[t * walkers + w]; }
};

/// Sokal's integrated autocorrelation time of the mean autocorrelation over the walkers.
double autocorrelation_time(const Paths& p) {
    std::vector<double> means(p.walkers, 0);
    double whole = 0;
    for (std::size_t t = 0; t < p.steps; ++t)
        for (std::size_t w = 0; w < p.walkers; ++w) whole += p.at(t, w);
    whole /= static_cast<double>(p.steps * p.walkers);
    const auto covariance = [&](std::size_t lag) {
        double sum = 0;
        for (std::size_t t = 0; t + lag < p.steps; ++t)
            for (std::size_t w = 0; w < p.walkers; ++w) sum += (p.at(t, w) - whole) * (p.at(t + lag, w) - whole);
        return sum / static_cast<double>((p.steps - lag) * p.walkers);
    };
    const double variance = covariance(0);
    if (!(variance > 0)) return static_cast<double>(p.steps);
    double time = 1;
    for (std::size_t lag = 1; lag < p.steps / 2; ++lag) {
        time += 2 * covariance(lag) / variance;
        if (static_cast<double>(lag) >= sokal_window * time) break;
    }
    return std::max(time, 1.0);
}

/// Split R of Gelman et al. (2013): halves of every walker's path as chains.
double scale_reduction(const Paths& p) {
    const std::size_t length = p.steps / 2, chains = 2 * p.walkers;
    std::vector<double> mean(chains, 0), variance(chains, 0);
    for (std::size_t c = 0; c < chains; ++c) {
        const std::size_t from = c < p.walkers ? 0 : length, w = c % p.walkers;
        for (std::size_t t = 0; t < length; ++t) mean[c] += p.at(from + t, w) / static_cast<double>(length);
        for (std::size_t t = 0; t < length; ++t)
            variance[c] += std::pow(p.at(from + t, w) - mean[c], 2) / static_cast<double>(length - 1);
    }
    double whole = 0, between = 0, inside = 0;
    for (std::size_t c = 0; c < chains; ++c) whole += mean[c] / static_cast<double>(chains);
    for (std::size_t c = 0; c < chains; ++c) {
        between += std::pow(mean[c] - whole, 2) / static_cast<double>(chains - 1);
        inside += variance[c] / static_cast<double>(chains);
    }
    const auto n = static_cast<double>(length);
    return std::sqrt((n - 1) / n + between / inside);
}

void judge_paths(PosteriorSample& sample, const std::vector<double>& trace, std::size_t walkers, std::size_t steps) {
    const std::size_t d = sample.dimensions;
    double longest = 1, worst = 1;
    for (std::size_t j = 0; j < d; ++j) {
        Paths p{std::vector<double>(steps * walkers), walkers, steps};
        for (std::size_t i = 0; i < p.values.size(); ++i) p.values[i] = trace[i * d + j];
        longest = std::max(longest, autocorrelation_time(p));
        worst = std::max(worst, scale_reduction(p));
    }
    sample.effective = static_cast<double>(walkers * steps) / longest;
    sample.scale_reduction = worst;
}

}  // namespace

PosteriorSample sample_posterior(const LogDensity& density, Rows starts, const PosteriorSettings& settings) {
    const std::size_t d = starts.dimensions;
    const std::size_t walkers = settings.walkers == 0 ? std::max<std::size_t>(32, 4 * d) : settings.walkers;
    if (d == 0 || starts.size() == 0 || walkers % 2 != 0 || walkers < 2 * (d + 1) || settings.steps < 8)
        throw std::invalid_argument(
            "posterior: needs a start, an even number of at least 2 (d + 1) walkers and 8 steps");
    const Draws draws{settings.seed};
    Ensemble e = begin(density, starts, walkers, draws);
    PosteriorSample sample;
    sample.dimensions = d;
    std::vector<double> trace;
    trace.reserve(settings.steps * walkers * d);
    std::size_t accepted = 0;
    for (std::size_t step = 1; step <= settings.settling + settings.steps; ++step) {
        const std::size_t moved = move_half(e, density, step, false, draws) + move_half(e, density, step, true, draws);
        if (step <= settings.settling) continue;
        accepted += moved;
        trace.insert(trace.end(), e.points.begin(), e.points.end());
        if ((step - settings.settling) % std::max<std::size_t>(settings.thinning, 1) != 0) continue;
        sample.points.insert(sample.points.end(), e.points.begin(), e.points.end());
        sample.density.insert(sample.density.end(), e.density.begin(), e.density.end());
    }
    sample.acceptance = static_cast<double>(accepted) / static_cast<double>(walkers * settings.steps);
    judge_paths(sample, trace, walkers, settings.steps);
    return sample;
}

PosteriorShape posterior_shape(Rows sample) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    if (sample.size() < 2) throw std::invalid_argument("posterior: a shape needs two points");
    const auto n = static_cast<Eigen::Index>(sample.size()), d = static_cast<Eigen::Index>(sample.dimensions);
    const Eigen::Map<const RowMajor> x(sample.values.data(), n, d);
    const Eigen::RowVectorXd mean = x.colwise().mean();
    const Eigen::MatrixXd centred = x.rowwise() - mean;
    const Eigen::MatrixXd covariance = centred.transpose() * centred / static_cast<double>(n - 1);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
    PosteriorShape shape;
    for (Eigen::Index j = 0; j < d; ++j) {
        shape.mean.push_back(mean(j));
        shape.sd.push_back(std::sqrt(covariance(j, j)));
        for (Eigen::Index k = 0; k < d; ++k)
            shape.correlation.push_back(covariance(j, k) / std::sqrt(covariance(j, j) * covariance(k, k)));
    }
    for (Eigen::Index j = d - 1; j >= 0; --j) {
        shape.widths.push_back(std::sqrt(std::max(axes.eigenvalues()(j), 0.0)));
        for (Eigen::Index k = 0; k < d; ++k) shape.directions.push_back(axes.eigenvectors()(k, j));
    }
    return shape;
}

}  // namespace grainsweep::stats
