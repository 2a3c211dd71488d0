// What has passed through a plane, or a part of it, in the phases that count: net, by centres, positive along the
// normal.
//
// The engine records every passage (dem/crossings.hpp), so the count is exact for any frames, also of particles that
// are fed and leave between two of them.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

template <bool by_mass>
class FlowProbe final : public machine::Probe {
public:
    explicit FlowProbe(const Options& options)
        : selection_(options), plane_{options.vector("point"), options.vector("normal")} {}

    [[nodiscard]] std::vector<dem::CountingPlane> planes() const override { return {plane_}; }
    void passed(const Frame& frame, const Passage& passage) override {
        if (!selection_.holds(frame, passage)) return;
        passed_ += (passage.forward ? 1 : -1) * (by_mass ? frame.mass_of(passage.id) : 1);
    }
    double look(const Frame&) override { return passed_; }
    void save(ByteWriter& out) const override { out.put(passed_); }
    void restore(ByteReader& in) override { in.get(passed_); }

private:
    Selection selection_;
    dem::CountingPlane plane_;
    double passed_ = 0;
};

constexpr std::array flow_options = {
    of_option, option("in", Field::Kind::region, "", "the part of the plane: where the centre passes it"),
    option("point", Field::Kind::vector, "m", "a point of the plane", true),
    option("normal", Field::Kind::direction, "", "the direction that counts positive", true)};

}  // namespace

ProbeInfo flow_mass() {
    return probe_row<FlowProbe<true>>("passed_mass", "kg",
                                      "mass that has passed through a plane; its slope is the mass flow", flow_options,
                                      {.source = Source::passages, .so_far = true});
}
ProbeInfo flow_number() {
    return probe_row<FlowProbe<false>>("passed_number", "1", "particles that have passed through a plane", flow_options,
                                       {.source = Source::passages, .so_far = true});
}

}  // namespace grainsweep::machine::probes
