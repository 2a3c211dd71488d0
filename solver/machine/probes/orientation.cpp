// Directions of clumps: of their axes with the least moment of inertia (the long ones), or with the largest (the
// normals of flat ones).
//
//     orientation = <(u . e)^2>: 1/3 as by chance, 1 all along e, 0 all across it
//     nematic order = largest eigenvalue of <(3 u u - 1)/2>: 0 as by chance, 1 all parallel
#include "solver/geometry/solid.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <algorithm>

namespace grainsweep::machine::probes {
namespace {

/// Calls visit(u) for every clump that counts.
class Directions {
public:
    explicit Directions(const Options& options)
        : selection_(options), longest_(options.word("axis", "long") == "long") {}
    template <class Visit>
    void each(const Frame& frame, Visit&& visit) const {
        frame.each_clump([&](std::size_t i, const dem::BodyState& clump) {
            if (!selection_.holds(frame, i)) return;
            const auto& moments = clump.inertia;
            const auto chosen =
                (longest_ ? std::ranges::min_element(moments) : std::ranges::max_element(moments)) - moments.begin();
            visit(dem::axes_of(clump.orientation)[static_cast<std::size_t>(chosen)]);
        });
    }

private:
    Selection selection_;
    bool longest_;
};

class Orientation final : public machine::Probe {
public:
    explicit Orientation(const Options& options) : directions_(options), along_(options.vector("along")) {}
    double look(const Frame& frame) override {
        double sum = 0, count = 0;
        directions_.each(frame, [&](const Vec3& u) {
            const double cosine = geometry::dot(u, along_);
            sum += cosine * cosine;
            ++count;
        });
        return count > 0 ? sum / count : undefined;
    }

private:
    Directions directions_;
    Vec3 along_;
};

class NematicOrder final : public machine::Probe {
public:
    explicit NematicOrder(const Options& options) : directions_(options) {}
    double look(const Frame& frame) override {
        geometry::Inertia sum{};  // of u u
        double count = 0;
        directions_.each(frame, [&](const Vec3& u) {
            geometry::add_square(sum, u, 1);
            ++count;
        });
        if (count == 0) return undefined;
        for (double& c : sum) c /= count;
        return 1.5 * std::ranges::max(geometry::solid_of(0, {}, sum).inertia) - 0.5;
    }

private:
    Directions directions_;
};

constexpr std::array<std::string_view, 2> direction_words = {"long", "short"};
constexpr Field direction_option =
    option("axis", Field::Kind::word, "",
           "'long': the axis of the least moment of inertia, 'short': of the largest; default: 'long'", false, {},
           direction_words);
constexpr std::array orientation_options = {
    of_option, in_option, direction_option,
    option("along", Field::Kind::direction, "", "the direction to which the axes are compared", true)};
constexpr std::array nematic_options = {of_option, in_option, direction_option};

}  // namespace

ProbeInfo orientation() {
    return probe_row<Orientation>("orientation", "1",
                                  "mean squared cosine between the axes of clumps and a direction; 1/3 as by chance",
                                  orientation_options);
}
ProbeInfo nematic_order() {
    return probe_row<NematicOrder>(
        "nematic_order", "1", "how parallel the axes of clumps are: 0 as by chance, 1 all parallel", nematic_options);
}

}  // namespace grainsweep::machine::probes
