// Profiles along a direction in equal bins. The value of a bin is the mean of a quantity of its particles, weighted by
// volume, or the sum of their volumes.
#include "solver/machine/binning.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator-;

enum class ProfileOf { solid_volume, velocity, share, count };

class Profile final : public machine::Probe {
public:
    explicit Profile(const Options& options)
        : in_(options.region("in")),
          of_species_(options.numbers("of")),
          along_(options.vector("along")),
          bins_(bins_along(options)),
          velocity_along_(options.vector("velocity_along", {1, 0, 0})) {
        const auto word = options.word("quantity", "solid_volume");
        of_ = word == "velocity" ? ProfileOf::velocity
              : word == "share"  ? ProfileOf::share
              : word == "count"  ? ProfileOf::count
                                 : ProfileOf::solid_volume;
    }
    double look(const Frame&) override { return undefined; }
    void profile(const Frame& frame, std::vector<Sample>& into) override {
        std::vector<double> sum(bins_.count, 0), weight(bins_.count, 0);
        for (std::size_t i = 0; i < frame.size(); ++i) {
            if (frame.state.mobile[i] == 0) continue;
            if (in_ && !in_->contains(frame.state.position[i])) continue;
            const bool counts =
                of_species_.empty() || std::ranges::find(of_species_, frame.species_of(i)) != of_species_.end();
            if (of_ != ProfileOf::share && !counts) continue;
            const std::size_t bin = bins_.at(dot(frame.state.position[i], along_));
            if (bin == bins_.count) continue;
            const double volume = of_ == ProfileOf::count ? 1 : frame.volume(i);
            weight[bin] += volume;
            if (of_ == ProfileOf::velocity) sum[bin] += volume * dot(frame.state.velocity[i], velocity_along_);
            if (of_ == ProfileOf::share && counts) sum[bin] += volume;
        }
        for (std::size_t bin = 0; bin < bins_.count; ++bin) {
            const double mean = weight[bin] > 0 ? sum[bin] / weight[bin] : undefined;
            into.push_back({.bin = bins_.centre(bin),
                            .value = of_ == ProfileOf::solid_volume || of_ == ProfileOf::count ? weight[bin] : mean});
        }
    }

private:
    std::optional<Region> in_;
    std::vector<std::size_t> of_species_;
    Vec3 along_;
    Bins bins_;
    Vec3 velocity_along_;
    ProfileOf of_ = ProfileOf::solid_volume;
};

constexpr std::array<std::string_view, 4> quantities = {"solid_volume", "velocity", "share", "count"};
constexpr std::array profile_options = {
    species_option,
    in_option,
    option("along", Field::Kind::direction, "", "the direction of the coordinate", true),
    option("from", Field::Kind::quantity, "m", "where the first bin begins", true),
    option("to", Field::Kind::quantity, "m", "where the last bin ends", true),
    bins_option,
    option("quantity", Field::Kind::word, "",
           "'solid_volume' (m3), 'velocity' (m/s), 'share' of the species by volume, or 'count'; default: solid_volume",
           false, {}, quantities),
    option("velocity_along", Field::Kind::direction, "", "the component of the velocity; default: x")};

}  // namespace

ProbeInfo profile() {
    return {"profile",
            "SI",
            "solid volume, velocity or share of species in bins along a direction",
            profile_options,
            make_probe<Profile>,
            false,
            "centre of the bin, m",
            flaw_of_bins_along};
}

}  // namespace grainsweep::machine::probes
