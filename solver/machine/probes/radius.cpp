// Mean distance from an axis, weighted by volume: the axis of the machine, or one through the centre of the bed.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::norm;
using geometry::operator-;
using geometry::operator+=;
using geometry::operator*;

class RadiusProbe final : public machine::Probe {
public:
    explicit RadiusProbe(const Options& options)
        : selection_(options),
          axis_(options.vector("axis")),
          through_(options.vector("through", {})),
          about_bed_(options.word("about", "axis") == "bed") {}
    double look(const Frame& frame) override {
        const Vec3 origin = about_bed_ ? centre_of_bed(frame) : through_;
        return selection_.mean_by_volume(frame, [&](std::size_t i) {
            const Vec3 x = frame.state.position[i] - origin;
            return norm(x - dot(x, axis_) * axis_);
        });
    }

private:
    static Vec3 centre_of_bed(const Frame& frame) {
        Vec3 moment{};
        double volume = 0;
        for (std::size_t i = 0; i < frame.size(); ++i) {
            if (frame.state.mobile[i] == 0) continue;
            moment += frame.volume(i) * frame.state.position[i];
            volume += frame.volume(i);
        }
        return volume > 0 ? (1 / volume) * moment : moment;
    }

    Selection selection_;
    Vec3 axis_, through_;
    bool about_bed_;
};

constexpr std::array<std::string_view, 2> abouts = {"axis", "bed"};
constexpr std::array radius_options = {
    of_option, in_option, option("axis", Field::Kind::direction, "", "the direction of the axis", true),
    option("through", Field::Kind::vector, "m", "a point on the axis; default: the origin"),
    option("about", Field::Kind::word, "",
           "'axis': the axis through that point; 'bed': through the centre of volume of all particles; default: axis",
           false, {}, abouts)};

}  // namespace

ProbeInfo radius() {
    return probe_row<RadiusProbe>("radius", "m", "mean distance from an axis, weighted by volume", radius_options);
}

}  // namespace grainsweep::machine::probes
