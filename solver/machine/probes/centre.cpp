// Mean position of particles along a direction, weighted by volume, from a point: the place of an intruder, the centre
// of a bed.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

using geometry::operator-;

class CentreProbe final : public machine::Probe {
public:
    explicit CentreProbe(const Options& options)
        : selection_(options), along_(options.vector("along")), from_(options.vector("from", {})) {}
    double look(const Frame& frame) override {
        return selection_.mean_by_volume(
            frame, [&](std::size_t i) { return geometry::dot(frame.state.position[i] - from_, along_); });
    }

private:
    Selection selection_;
    Vec3 along_, from_;
};

constexpr std::array centre_options = {
    of_option, in_option, option("along", Field::Kind::direction, "", "the direction of the coordinate", true),
    option("from", Field::Kind::vector, "m", "the point from which it counts; default: the origin")};

}  // namespace

ProbeInfo centre() {
    return probe_row<CentreProbe>("centre", "m", "mean position along a direction, weighted by volume", centre_options);
}

}  // namespace grainsweep::machine::probes
