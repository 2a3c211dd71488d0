// Heights against gravity, from a point: below which a share of the solid volume lies, and the mean.
#include "solver/machine/probe.hpp"
#include "solver/machine/upright.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator-;

/// Returns the height of the highest point of a clump above its centre of mass, m.
double top_of(const dem::State& spheres, const dem::BodyState& clump, const Vec3& up) {
    const auto first = static_cast<std::size_t>(std::ranges::lower_bound(spheres.id, clump.first) - spheres.id.begin());
    double top = -std::numeric_limits<double>::infinity();
    for (std::size_t i = first; i < first + clump.members; ++i)
        top = std::max(top, dot(spheres.position[i] - clump.position, up) + spheres.radius[i]);
    return top;
}

class HeightOfShare final : public machine::Probe {
public:
    explicit HeightOfShare(const Options& options)
        : selection_(options),
          share_(options.number("share", 0.95)),
          from_(options.vector("from", {})),
          along_(options.given<Vec3>("along")),
          surface_(options.word("of_sphere", "top") == "top") {}
    double look(const Frame& frame) override {
        const Vec3 up = up_of(frame, along_);
        std::vector<std::pair<double, double>> heights;
        double volume = 0;
        std::map<std::size_t, double> tops;  // of clumps: of their highest spheres
        if (surface_)
            frame.each_clump(
                [&](std::size_t i, const dem::BodyState& clump) { tops[i] = top_of(frame.spheres(), clump, up); });
        selection_.each(frame, [&](std::size_t i) {
            const auto top = tops.find(i);
            const double above = !surface_ ? 0 : top == tops.end() ? frame.state.radius[i] : top->second;
            heights.emplace_back(dot(frame.state.position[i] - from_, up) + above, frame.volume(i));
            volume += frame.volume(i);
        });
        std::ranges::sort(heights);
        double below = 0;
        for (const auto& [height, of_it] : heights)
            if ((below += of_it) >= share_ * volume) return height;
        return heights.empty() ? undefined : heights.back().first;  // a sum in another order differs by rounding
    }

private:
    Selection selection_;
    double share_;
    Vec3 from_;
    std::optional<Vec3> along_;
    bool surface_;
};

class MeanHeight final : public machine::Probe {
public:
    explicit MeanHeight(const Options& options)
        : selection_(options), from_(options.vector("from", {})), along_(options.given<Vec3>("along")) {}
    double look(const Frame& frame) override {
        const Vec3 up = up_of(frame, along_);
        return selection_.mean_by_volume(frame,
                                         [&](std::size_t i) { return dot(frame.state.position[i] - from_, up); });
    }

private:
    Selection selection_;
    Vec3 from_;
    std::optional<Vec3> along_;
};

constexpr std::array<std::string_view, 2> ends = {"top", "centre"};
constexpr std::array height_options = {
    of_option,
    in_option,
    from_option,
    along_option,
    option("share", Field::Kind::quantity, "1", "share of the solid volume below; default: 0.95", false,
           {0, 1, true, false}),
    option("of_sphere", Field::Kind::word, "", "'top' or 'centre' of the spheres; default: top", false, {}, ends)};
constexpr std::array mean_height_options = {of_option, in_option, from_option, along_option};

}  // namespace

ProbeInfo height_of_share() {
    return probe_row<HeightOfShare>(
        "height", "m", "height below which a share of the solid volume lies: the top of a bed", height_options);
}
ProbeInfo mean_height() {
    return probe_row<MeanHeight>("mean_height", "m", "mean height, weighted by volume", mean_height_options);
}

}  // namespace grainsweep::machine::probes
