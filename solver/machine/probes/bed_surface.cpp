// Surface of a bed in a rotating drum and the flow below it, from sums over all frames so far. The value at the last
// frame is the result for the whole time. Definitions: solver/observables/turned_bed.hpp.
#include "solver/machine/probe.hpp"
#include "solver/machine/probes/section.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace grainsweep::machine::probes {
namespace {

enum class Surface { angle, residual, speed, depth };

constexpr double most_section_cells = 4e5;  // of D by D, across the drum

template <Surface of>
class BedSurfaceProbe final : public machine::Probe {
public:
    explicit BedSurfaceProbe(const Options& options)
        : look_(options),
          radius_(options.number("radius")),
          diameter_(options.number("diameter")),
          solid_(radius_, options.number("length"), diameter_) {
        if (of == Surface::speed || of == Surface::depth) flow_.emplace(radius_, diameter_);
    }

    double look(const Frame& frame) override {
        if (once_(frame)) {
            if (const auto section = look_(frame)) {
                solid_.add(*section);
                if (flow_) flow_->add(*section);
            }
        }
        const observables::Line line = solid_.surface_line(radius_);
        if (of == Surface::angle) return std::atan(0 - line.slope) * 180 / std::numbers::pi;
        if (of == Surface::residual) return line.residual / diameter_;
        const auto below = flow_->below(line);
        return of == Surface::speed ? below.surface_speed : below.depth;
    }

    void save(ByteWriter& out) const override {
        once_.save(out);
        save_sum(solid_, out);
        if (flow_) save_sum(*flow_, out);
    }
    void restore(ByteReader& in) override {
        once_.restore(in);
        restore_sum(solid_, in);
        if (flow_) restore_sum(*flow_, in);
    }

private:
    SectionLook look_;
    double radius_, diameter_;
    FramesOnce once_;
    observables::SolidFraction solid_;
    std::optional<observables::SectionFlow> flow_;
};

std::string flaw_of_bed_surface(const Options& given) {
    const double across = 2 * given.number("radius") / given.number("diameter");
    return across * across <= most_section_cells ? "" : "\"radius\" is at most 316 times \"diameter\"";
}

constexpr std::array bed_surface_options = {
    of_option,
    in_option,
    section_axis_option,
    section_through_option,
    section_radius_option,
    option("length", Field::Kind::quantity, "m", "length of the drum", true, {0, 1e3, true, false}),
    section_diameter_option};

template <Surface of>
constexpr ProbeInfo bed_surface_row(std::string_view name, std::string_view unit, std::string_view meaning) {
    return probe_row<BedSurfaceProbe<of>>(name, unit, meaning, bed_surface_options, {.flaw = flaw_of_bed_surface});
}

}  // namespace

ProbeInfo bed_surface_angle() {
    return bed_surface_row<Surface::angle>("bed_surface_angle", "deg",
                                           "slope of the line through the heights where the mean solid fraction since "
                                           "the first frame, on cells of D, falls "
                                           "through 0.3, within 0.4 R of the axis");
}
ProbeInfo bed_surface_residual() {
    return bed_surface_row<Surface::residual>(
        "bed_surface_residual", "1", "root mean square of those heights above and below their line, divided by D");
}
ProbeInfo bed_surface_speed() {
    return bed_surface_row<Surface::speed>("bed_surface_speed", "m/s",
                                           "mean velocity down that line, of centres 0 to 1 D below it and within 2.5 "
                                           "D of the foot of the perpendicular from "
                                           "the axis");
}
ProbeInfo bed_layer_depth() {
    return bed_surface_row<Surface::depth>(
        "bed_layer_depth", "1", "depth below that line at which the mean velocity along it changes sign, divided by D");
}

}  // namespace grainsweep::machine::probes
