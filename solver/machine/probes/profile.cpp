// Profiles along a direction in equal bins. The value of a bin is the mean of a quantity of its particles, weighted by
// volume, or the sum of their volumes.
#include "solver/machine/binning.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"
#include "solver/observables/layer.hpp"

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator-;

enum class ProfileOf { solid_volume, velocity, share, count, cut_volume };

class Profile final : public machine::Probe {
public:
    explicit Profile(const Options& options)
        : in_(options.region("in")),
          of_species_(options),
          along_(options.vector("along")),
          bins_(bins_along(options)),
          velocity_along_(options.vector("velocity_along", {1, 0, 0})) {
        const auto word = options.word("quantity", "solid_volume");
        of_ = word == "velocity"     ? ProfileOf::velocity
              : word == "share"      ? ProfileOf::share
              : word == "count"      ? ProfileOf::count
              : word == "cut_volume" ? ProfileOf::cut_volume
                                     : ProfileOf::solid_volume;
        if (options.word("bin", "centre") == "top") shown_ = 0.5;
    }
    double look(const Frame&) override { return undefined; }
    void profile(const Frame& frame, std::vector<Sample>& into) override {
        std::vector<double> sum(bins_.count, 0), weight(bins_.count, 0);
        const auto here = now(in_);
        for (std::size_t i = 0; i < frame.size(); ++i) {
            if (frame.state.mobile[i] == 0) continue;
            if (here && !here->contains(frame.state.position[i])) continue;
            const bool counts = of_species_.hold(frame, frame.id(i));
            if (of_ != ProfileOf::share && !counts) continue;
            if (of_ == ProfileOf::cut_volume) {
                cut(dot(frame.state.position[i], along_), frame.state.radius[i], weight);
                continue;
            }
            const std::size_t bin = bins_.at(dot(frame.state.position[i], along_));
            if (bin == bins_.count) continue;
            const double volume = of_ == ProfileOf::count ? 1 : frame.volume(i);
            weight[bin] += volume;
            if (of_ == ProfileOf::velocity) sum[bin] += volume * dot(frame.state.velocity[i], velocity_along_);
            if (of_ == ProfileOf::share && counts) sum[bin] += volume;
        }
        for (std::size_t bin = 0; bin < bins_.count; ++bin) {
            const double mean = weight[bin] > 0 ? sum[bin] / weight[bin] : undefined;
            const bool sums = of_ != ProfileOf::velocity && of_ != ProfileOf::share;
            into.push_back({.bin = bins_.centre(bin) + shown_ * bins_.width(), .value = sums ? weight[bin] : mean});
        }
    }

private:
    /// Adds the parts of a sphere to the bins in which they lie.
    void cut(double centre, double radius, std::vector<double>& into) const {
        for (std::size_t bin = 0; bin < bins_.count; ++bin) {
            const double low = bins_.low + static_cast<double>(bin) * bins_.width();
            into[bin] += observables::sphere_below(low + bins_.width() - centre, radius) -
                         observables::sphere_below(low - centre, radius);
        }
    }

    double shown_ = 0;  // of a bin: place over its centre, bins
    std::optional<Region> in_;
    SelectedSpecies of_species_;
    Vec3 along_;
    Bins bins_;
    Vec3 velocity_along_;
    ProfileOf of_ = ProfileOf::solid_volume;
};

constexpr std::array<std::string_view, 5> quantities = {"solid_volume", "velocity", "share", "count", "cut_volume"};
constexpr std::array<std::string_view, 2> bin_places = {"centre", "top"};
constexpr std::array profile_options = {
    species_option,
    in_option,
    coordinate_option,
    first_bin_option,
    last_bin_option,
    bins_option,
    option("quantity", Field::Kind::word, "",
           "'solid_volume' (m3), 'velocity' (m/s), 'share' of the species by volume, 'count', or 'cut_volume' (m3): "
           "spheres are cut at the ends of bins; default: solid_volume",
           false, {}, quantities),
    option("bin", Field::Kind::word, "", "what is shown of a bin: its 'centre' or 'top'; default: centre", false, {},
           bin_places),
    option("velocity_along", Field::Kind::direction, "", "the component of the velocity; default: x")};

}  // namespace

ProbeInfo profile() {
    return probe_row<Profile>("profile", "SI", "solid volume, velocity or share of species in bins along a direction",
                              profile_options, {.over = "centre of the bin, m", .flaw = flaw_of_bins_along});
}

}  // namespace grainsweep::machine::probes
