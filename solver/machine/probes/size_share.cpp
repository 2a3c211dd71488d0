// Share of a region in the mass of each size, of what lies in it and in a second one: the partition curve of a screen.
#include "solver/machine/binning.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::machine::probes {
namespace {

class SizeShare final : public machine::Probe {
public:
    explicit SizeShare(const Options& options)
        : selection_(options), beside_(options.region("beside")), bins_(bins_along(options)) {}
    void restart() override { seen_.clear(); }
    double look(const Frame&) override { return undefined; }
    void profile(const Frame& frame, std::vector<Sample>& into) override {
        for (std::size_t i = 0; i < frame.size(); ++i) {
            if (frame.state.mobile[i] == 0 || !selection_.is_of(frame, frame.id(i))) continue;
            const Vec3& x = frame.state.position[i];
            const bool in = selection_.region()->contains(x), beside = !in && (!beside_ || beside_->contains(x));
            keep(frame.id(i), {2 * frame.state.radius[i], in ? frame.mass(i) : 0, beside ? frame.mass(i) : 0});
        }
        std::vector<double> inside(bins_.count, 0), all(bins_.count, 0);
        for (const Seen& one : seen_) {
            const std::size_t bin = bins_.at(one.diameter);
            if (bin == bins_.count) continue;
            inside[bin] += one.in;
            all[bin] += one.in + one.beside;
        }
        append_bins(into, bins_, [&](std::size_t b) { return all[b] > 0 ? inside[b] / all[b] : undefined; });
    }
    void save(ByteWriter& out) const override { out.put(seen_); }
    void restore(ByteReader& in) override { in.get(seen_); }

private:
    /// Particle where it was last seen.
    struct Seen {
        double diameter = 0;        ///< m
        double in = 0, beside = 0;  ///< mass in each of the two regions, kg
    };
    void keep(std::size_t id, const Seen& one) {
        if (id >= seen_.size()) seen_.resize(id + 1);
        seen_[id] = one;
    }

    Selection selection_;
    std::optional<Region> beside_;
    Bins bins_;
    std::vector<Seen> seen_;  // by id
};

constexpr std::array size_share_options = {
    of_option,
    option("in", Field::Kind::region, "", "the region whose share is shown, such as all below a deck", true),
    option("beside", Field::Kind::region, "",
           "the other region of the whole, such as all behind the end of the deck; default: everywhere else"),
    option("from", Field::Kind::quantity, "m", "the diameter where the first bin begins", true),
    option("to", Field::Kind::quantity, "m", "the diameter where the last bin ends", true),
    bins_option};

}  // namespace

ProbeInfo size_share() {
    return probe_row<SizeShare>(
        "size_share", "1",
        "share of a region in the mass of each diameter, of particles where they were last seen: a partition curve",
        size_share_options, {.over = "diameter, m", .flaw = flaw_of_bins_along, .so_far = true});
}

}  // namespace grainsweep::machine::probes
