// Wear of walls by particles that slide on them.
//
//     W = sum over steps and contacts of |F_n| |v_t| dt  while friction slides         worn volume = (k/H) W
//
// Archard (1953), J. Appl. Phys. 24, 981; k: wear coefficient, 1; H: hardness of the wall, Pa. v_t is the velocity of
// the particle's surface over that of the wall. Steps in which the contact sticks or attracts count for nothing: what
// its spring gives way is no sliding. The profile has W by the place of the contact, in space: a place that is at rest
// while a wall turns under it.
#include "solver/machine/binning.hpp"
#include "solver/machine/contact_place.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

class WallWear final : public machine::Probe {
public:
    explicit WallWear(const Options& options)
        : walls_(options),
          of_(options),
          in_(options.region("in")),
          along_(options.vector("along", {})),
          bins_(bins_along(options)),
          in_bins_(bins_.count, 0.0) {}

    void step(const Frame& frame) override {
        for (const auto& contact : frame.contacts) {
            if (!contact.slides || !(contact.normal_force > 0)) continue;
            if (!walls_.touch(contact) || !of_.hold(frame, contact.first)) continue;
            const double wear = contact.normal_force * geometry::norm(contact.slip) * frame.time_step;
            if (!in_ && bins_.count == 0) {
                wear_ += wear;
                continue;
            }
            const Vec3 x = contact_point(frame, contact);
            if (in_ && !in_->contains(x)) continue;
            wear_ += wear;
            if (bins_.count == 0) continue;
            if (const std::size_t bin = bins_.at(geometry::dot(x, along_)); bin < bins_.count) in_bins_[bin] += wear;
        }
    }
    double look(const Frame&) override { return walls_.none() ? undefined : wear_; }
    void profile(const Frame&, std::vector<Sample>& into) override {
        append_bins(into, bins_, [this](std::size_t b) { return in_bins_[b]; });
    }
    void save(ByteWriter& out) const override { out.put(wear_), out.put(in_bins_); }
    void restore(ByteReader& in) override {
        in.get(wear_), in.get(in_bins_);
        in.require(in_bins_.size() == bins_.count);
    }

private:
    SelectedWalls walls_;
    SelectedSpecies of_;
    std::optional<Region> in_;
    Vec3 along_;
    Bins bins_;
    double wear_ = 0;  // J
    std::vector<double> in_bins_;
};

constexpr std::array wear_options = {walls_option, species_option, contact_in_option};
constexpr std::array wear_profile_options = {walls_option,     species_option,  contact_in_option, coordinate_option,
                                             first_bin_option, last_bin_option, bins_option};

}  // namespace

ProbeInfo wall_wear() {
    return probe_row<WallWear>(
        "wall_wear", "J",
        "normal force times sliding distance on walls; times Archard's coefficient and divided by the "
        "hardness: the volume worn off",
        wear_options, {.source = Source::steps, .so_far = true});
}
ProbeInfo wall_wear_profile() {
    return probe_row<WallWear>(
        "wall_wear_profile", "J", "the same in bins along a direction", wear_profile_options,
        {.over = "centre of the bin, m", .flaw = flaw_of_bins_along, .source = Source::steps, .so_far = true});
}

}  // namespace grainsweep::machine::probes
