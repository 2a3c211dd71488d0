// Residence times between two planes: for each particle the time from its first passage of the first plane to its first
// passage of the second, both along the direction.
//
// Between two frames the velocity of a particle is taken as constant; the error is at most v' dt^2/(8 v) for an
// acceleration v'. A particle that is absent at the next frame is taken to fly freely. What starts behind the first
// plane is not counted, nor what has not arrived.
#include "solver/machine/binning.hpp"
#include "solver/machine/probes/probes.hpp"
#include "solver/machine/selection.hpp"

#include <cmath>

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;

enum class OfResidence { mean, deviation, density };

template <OfResidence what>
class ResidenceTime final : public machine::Probe {
public:
    explicit ResidenceTime(const Options& options)
        : selection_(options),
          along_(options.vector("along")),
          first_(options.number("from")),
          second_(options.number("to")),
          bins_{0, options.number("longest", 1), options.has("longest") ? bins_in(options) : 0} {}

    double look(const Sight& sight) override {
        if (seen_.size() < sight.species.size()) seen_.resize(sight.species.size());
        const double span = sight.time - time_;
        std::vector<char> here(seen_.size(), 0);
        for (std::size_t i = 0; i < sight.size(); ++i) {
            if (!selection_.holds(sight, i)) continue;
            Seen& seen = seen_[sight.id(i)];
            here[sight.id(i)] = 1;
            const double s = dot(sight.state.position[i], along_);
            if (seen.there != 0) pass(seen, s, span);
            seen.there = 1, seen.s = s, seen.v = dot(sight.state.velocity[i], along_);
        }
        for (std::size_t id = 0; id < seen_.size(); ++id) {
            Seen& seen = seen_[id];
            if (here[id] != 0 || seen.there == 0) continue;
            pass(seen, seen.s + seen.v * span + dot(sight.gravity, along_) * span * span / 2, span);
            seen.there = 0;
        }
        time_ = sight.time;
        return value();
    }
    void profile(const Sight&, std::vector<Sample>& into) override {
        std::vector<double> numbers(bins_.count, 0.0);
        for (const double t : times_)
            if (const std::size_t bin = bins_.at(t); bin < bins_.count) numbers[bin] += 1;
        for (std::size_t b = 0; b < bins_.count; ++b)
            into.push_back(
                {.bin = bins_.centre(b), .value = numbers[b] / (static_cast<double>(times_.size()) * bins_.width())});
    }
    void save(ByteWriter& out) const override { out.put(time_), out.put(seen_), out.put(times_); }
    void restore(ByteReader& in) override { in.get(time_), in.get(seen_), in.get(times_); }

private:
    /// A particle as it was last.
    struct Seen {
        std::int64_t there = 0;
        double s = 0, v = 0;         // along the direction, m and m/s
        double entered = undefined;  // s since the start
        std::int64_t left = 0;       // has passed the second plane
    };

    /// The way of a frame, from where it was seen to s.
    void pass(Seen& seen, double s, double span) {
        const auto when = [&](double plane) { return time_ + span * (plane - seen.s) / (s - seen.s); };
        if (!std::isfinite(seen.entered) && seen.s < first_ && s >= first_) seen.entered = when(first_);
        if (!std::isfinite(seen.entered) || seen.left != 0 || !(seen.s < second_ && s >= second_)) return;
        seen.left = 1;
        times_.push_back(when(second_) - seen.entered);
    }
    [[nodiscard]] double value() const {
        if (times_.empty() || what == OfResidence::density) return undefined;
        double mean = 0, squares = 0;
        const auto count = static_cast<double>(times_.size());
        for (const double t : times_) mean += t / count;
        for (const double t : times_) squares += (t - mean) * (t - mean) / count;
        return what == OfResidence::mean ? mean : std::sqrt(squares);
    }

    Selection selection_;
    Vec3 along_;
    double first_, second_;
    Bins bins_;
    double time_ = 0;
    std::vector<Seen> seen_;     // by id
    std::vector<double> times_;  // s, of those that have passed both
};

std::string flaw_of_residence_time(const Options& given) {
    if (!(given.number("from") < given.number("to"))) return "\"from\" of a residence time must lie before \"to\"";
    return given.has("longest") ? flaw_of_bins(given, 0, given.number("longest")) : "";
}

constexpr OptionSpec residence_along{"along", OptionSpec::Kind::direction, "",
                                     "the direction across both planes, from one to the other", true};
constexpr OptionSpec residence_from{"from", OptionSpec::Kind::number, "m", "where the first plane is along it", true};
constexpr OptionSpec residence_to{"to", OptionSpec::Kind::number, "m", "where the second plane is along it", true};
constexpr std::array residence_options = {of_option, in_option, residence_along, residence_from, residence_to};
constexpr std::array residence_density_options = {of_option,
                                                  in_option,
                                                  residence_along,
                                                  residence_from,
                                                  residence_to,
                                                  OptionSpec{"longest",
                                                             OptionSpec::Kind::number,
                                                             "s",
                                                             "residence time at which the last bin ends",
                                                             true,
                                                             {0, 1e9, true, false}},
                                                  bins_option};

template <OfResidence what>
std::unique_ptr<machine::Probe> make_residence(const Options& given) {
    return std::make_unique<ResidenceTime<what>>(given);
}

}  // namespace

const ProbeInfo residence_time{"residence_time",
                               "s",
                               "mean time of the particles so far from one plane to another",
                               residence_options,
                               make_residence<OfResidence::mean>,
                               false,
                               {},
                               flaw_of_residence_time};
const ProbeInfo residence_time_sd{"residence_time_sd",
                                  "s",
                                  "standard deviation of those times",
                                  residence_options,
                                  make_residence<OfResidence::deviation>,
                                  false,
                                  {},
                                  flaw_of_residence_time};

const ProbeInfo residence_time_density{"residence_time_density",
                                       "1/s",
                                       "probability density of those times",
                                       residence_density_options,
                                       make_residence<OfResidence::density>,
                                       false,
                                       "residence time, s",
                                       flaw_of_residence_time};

}  // namespace grainsweep::machine::probes
