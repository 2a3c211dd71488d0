// Number, mass, solid volume and mean diameter of the particles whose centres lie in a region.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <numeric>
#include <vector>

namespace grainsweep::machine::probes {
namespace {

enum class Amount { count, mass, volume };

template <Amount of>
class AmountProbe final : public machine::Probe {
public:
    explicit AmountProbe(const Options& options)
        : latest_(options.word("filling", "any") == "latest"),
          keeps_(options.word("gone", "leave") == "stay"),
          selection_(options),
          slower_than_(options.given<double>("slower_than")) {}
    void restart() override { amount_.clear(); }
    double look(const Frame& frame) override {
        double sum = 0;
        const auto holds = selection_.at(frame);
        for (std::size_t i = 0; i < frame.size(); ++i) {
            const bool counts = (!latest_ || frame.id(i) >= frame.newest) && holds(i) &&
                                (!slower_than_ || geometry::norm(frame.state.velocity[i]) < *slower_than_);
            const double one = !counts               ? 0
                               : of == Amount::count ? 1
                               : of == Amount::mass  ? frame.mass(i)
                                                     : frame.volume(i);
            sum += one;
            if (keeps_) keep(frame.id(i), one);
        }
        return keeps_ ? std::accumulate(amount_.begin(), amount_.end(), 0.0) : sum;
    }
    void save(ByteWriter& out) const override { out.put(amount_); }
    void restore(ByteReader& in) override { in.get(amount_); }

private:
    void keep(std::size_t id, double amount) {
        if (id >= amount_.size()) amount_.resize(id + 1, 0.0);
        amount_[id] = amount;
    }

    bool latest_, keeps_;
    std::vector<double> amount_;  // by id, when last seen
    Selection selection_;
    std::optional<double> slower_than_;
};

double mean_diameter_of(const Frame& frame, const Selection& selection) {
    double diameters = 0, number = 0;
    selection.each(frame, [&](std::size_t i) {
        diameters += 2 * frame.state.radius[i];
        number += 1;
    });
    return number > 0 ? diameters / number : undefined;
}

constexpr std::array mean_diameter_options = {of_option, in_option};
constexpr std::array<std::string_view, 2> filling_words = {"any", "latest"}, gone_words = {"leave", "stay"};
constexpr std::array amount_options = {
    of_option, in_option,
    option("slower_than", Field::Kind::quantity, "m/s", "only particles slower than this; default: all", false,
           positive_number),
    option("filling", Field::Kind::word, "", "'latest': only particles of the latest filling; default: any", false, {},
           filling_words),
    option("gone", Field::Kind::word, "",
           "'stay': those that have left the domain count where they were last seen; default: leave", false, {},
           gone_words)};

}  // namespace

ProbeInfo amount_count() {
    return probe_row<AmountProbe<Amount::count>>("count", "1", "number of particles in a region", amount_options);
}
ProbeInfo amount_mass() {
    return probe_row<AmountProbe<Amount::mass>>("mass", "kg", "mass of the particles in a region", amount_options);
}
ProbeInfo amount_volume() {
    return probe_row<AmountProbe<Amount::volume>>("volume", "m3", "solid volume of the particles in a region",
                                                  amount_options);
}
ProbeInfo mean_diameter() {
    return probe_row<SelectionProbe<mean_diameter_of>>(
        "mean_diameter", "m", "mean diameter of the particles in a region, by number", mean_diameter_options);
}

}  // namespace grainsweep::machine::probes
