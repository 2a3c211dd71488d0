// The shape of a heap on a plate, as solver/observables/heap.hpp defines it: columns and rings of the width "cell"
// about the mass centre. Particles that never move belong to the plate.
#include "solver/observables/heap.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/upright.hpp"

namespace grainsweep::machine::probes {
namespace {

using observables::HeapShape;

class HeapProbe : public machine::Probe {
public:
    HeapProbe(const Options& options, double HeapShape::*value)
        : upright_(options), cell_(options.number("cell")), reach_(options.number("reach")), value_(value) {}
    double look(const Frame& frame) override { return value_ == nullptr ? undefined : shape_in(frame).*value_; }
    void profile(const Frame& frame, std::vector<Sample>& into) override {
        const auto shape = shape_in(frame);
        for (std::size_t k = 0; k < shape.outline.size(); ++k)
            into.push_back({.bin = (static_cast<double>(k) + 0.5) * cell_, .value = shape.outline[k]});
    }

private:
    [[nodiscard]] HeapShape shape_in(const Frame& frame) const {
        return observables::heap_shape(upright_.state_of(frame), cell_, reach_);
    }

    Upright upright_;
    double cell_, reach_;
    double HeapShape::*value_;  // nullptr: the outline
};

template <double HeapShape::*value>
class HeapOf final : public HeapProbe {
public:
    explicit HeapOf(const Options& given) : HeapProbe(given, value) {}
};

class HeapAngle final : public HeapProbe {
public:
    explicit HeapAngle(const Options& given)
        : HeapProbe(given, given.word("by", "moments") == "moments" ? &HeapShape::angle_moment : &HeapShape::angle) {}
};

std::string flaw_of_heap(const Options& given) {
    return given.number("reach") <= 1e5 * given.number("cell") ? "" : "\"reach\" is more than 1e5 times \"cell\"";
}

constexpr Interval above_zero{0, std::numeric_limits<double>::infinity(), true, true};
constexpr Field heap_cell_option =
    option("cell", Field::Kind::quantity, "m", "width of columns and rings: about one particle", true, above_zero);
constexpr Field reach_option =
    option("reach", Field::Kind::quantity, "m", "radius of the outermost ring about the mass centre", true, above_zero);
constexpr std::array<std::string_view, 2> angles = {"moments", "outline"};
constexpr std::array heap_options = {of_option, in_option, from_option, along_option, heap_cell_option, reach_option};
constexpr std::array heap_angle_options = {
    of_option,
    in_option,
    from_option,
    along_option,
    heap_cell_option,
    reach_option,
    option("by", Field::Kind::word, "",
           "'moments': atan(2 z_c/<r>) within the first ring lower than half a cell, exact for an even cone; "
           "'outline': slope of the rings between 0.2 and 0.8 of the height; default: moments",
           false, {}, angles)};

}  // namespace

ProbeInfo heap_angle() {
    return probe_row<HeapAngle>("heap_angle", "deg", "angle of repose of a heap", heap_angle_options,
                                {.flaw = flaw_of_heap});
}
ProbeInfo heap_height() {
    return probe_row<HeapOf<&HeapShape::height>>("heap_height", "m",
                                                 "height of a heap: the highest of the inner three rings", heap_options,
                                                 {.flaw = flaw_of_heap});
}
ProbeInfo heap_residual() {
    return probe_row<HeapOf<&HeapShape::residual>>(
        "heap_residual", "m", "root mean square height of a heap's outline off the line of its slope", heap_options,
        {.flaw = flaw_of_heap});
}
ProbeInfo heap_run_out() {
    return probe_row<HeapOf<&HeapShape::run_out>>(
        "heap_run_out", "m", "distance from the mass centre within which nine tenths of the particles lie",
        heap_options, {.flaw = flaw_of_heap});
}
ProbeInfo heap_outline() {
    return probe_row<HeapOf<nullptr>>("heap_outline", "m",
                                      "mean height of a heap's surface in rings about the mass centre", heap_options,
                                      {.over = "radius of the middle of the ring, m", .flaw = flaw_of_heap});
}

}  // namespace grainsweep::machine::probes
