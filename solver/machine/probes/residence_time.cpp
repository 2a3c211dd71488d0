// Residence times between two planes: for each particle the time from its first passage of the first plane to its first
// passage of the second, both along the direction.
//
// The engine records every passage (dem/crossings.hpp), so the times are exact to a step for any frames. What starts
// behind the first plane is counted once it has passed it, and what has not arrived is not counted.
#include "solver/machine/binning.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <cmath>

namespace grainsweep::machine::probes {
namespace {

using geometry::operator*;

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

    [[nodiscard]] std::vector<dem::CountingPlane> planes() const override {
        return {{first_ * along_, along_}, {second_ * along_, along_}};
    }
    void passed(const Frame& frame, const Passage& passage) override {
        if (!passage.forward || !selection_.holds(frame, passage)) return;
        if (passage.id >= seen_.size()) seen_.resize(passage.id + 1);
        Seen& seen = seen_[passage.id];
        if (passage.plane == 0) {
            if (!std::isfinite(seen.entered)) seen.entered = passage.time;
        } else if (std::isfinite(seen.entered) && seen.left == 0) {
            seen.left = 1;
            times_.push_back(passage.time - seen.entered);
        }
    }
    double look(const Frame&) override { return value(); }
    void profile(const Frame&, std::vector<Sample>& into) override { append_density(into, bins_, times_, 1); }
    void save(ByteWriter& out) const override { out.put(seen_), out.put(times_); }
    void restore(ByteReader& in) override { in.get(seen_), in.get(times_); }

private:
    struct Seen {
        double entered = undefined;  // s since the start
        std::int64_t left = 0;       // has passed the second plane
    };

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
    std::vector<Seen> seen_;     // by id, as far as particles have passed
    std::vector<double> times_;  // s, of those that have passed both
};

std::string flaw_of_residence_time(const Options& given) {
    if (!(given.number("from") < given.number("to"))) return "\"from\" of a residence time must lie before \"to\"";
    return given.has("longest") ? flaw_of_bins(given, 0, given.number("longest")) : "";
}

constexpr Field residence_along =
    option("along", Field::Kind::direction, "", "the direction across both planes, from one to the other", true);
constexpr Field residence_from = option("from", Field::Kind::quantity, "m", "where the first plane is along it", true);
constexpr Field residence_to = option("to", Field::Kind::quantity, "m", "where the second plane is along it", true);
constexpr std::array residence_options = {of_option, in_option, residence_along, residence_from, residence_to};
constexpr std::array residence_density_options = {
    of_option,
    in_option,
    residence_along,
    residence_from,
    residence_to,
    option("longest", Field::Kind::quantity, "s", "residence time at which the last bin ends", true,
           {0, 1e9, true, false}),
    bins_option};

}  // namespace

ProbeInfo residence_time() {
    return probe_row<ResidenceTime<OfResidence::mean>>(
        "residence_time", "s", "mean time of the particles so far from one plane to another", residence_options,
        {.flaw = flaw_of_residence_time, .source = Source::passages, .so_far = true});
}
ProbeInfo residence_time_sd() {
    return probe_row<ResidenceTime<OfResidence::deviation>>(
        "residence_time_sd", "s", "standard deviation of those times", residence_options,
        {.flaw = flaw_of_residence_time, .source = Source::passages, .so_far = true});
}

ProbeInfo residence_time_density() {
    return probe_row<ResidenceTime<OfResidence::density>>(
        "residence_time_density", "1/s", "probability density of those times", residence_density_options,
        {.over = "residence time, s", .flaw = flaw_of_residence_time, .source = Source::passages, .so_far = true});
}

}  // namespace grainsweep::machine::probes
