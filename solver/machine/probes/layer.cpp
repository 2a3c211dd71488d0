// Layer that was spread over a base or over earlier layers, and the powder that a tool pushes ahead
// (solver/observables/layer.hpp). x is along the travel, y across, z up; across, the region repeats itself.
//
// Of a further layer, powder from before the latest filling is its base: what counts is what the region has gained.
#include "solver/observables/layer.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <array>
#include <cmath>

namespace grainsweep::machine::probes {
namespace {

/// Part of the layer that is measured, and its particles with y from its side on. A part as wide as a period repeats
/// itself; another one has sides.
struct LayerPart {
    enum class Takes { centres, surfaces };  ///< particles with the centre, or a part, between the sides
    double from = 0, to = 0, width = 0;
    bool repeats = false;
    dem::State powder;

    /// `newest`: only particles of the latest filling.
    LayerPart(const Frame& frame, const Options& options, Takes takes, bool newest = false)
        : frame_(&frame), takes_(takes) {
        const Bounds bounds = options.region("in")->bounds();
        from = std::max(bounds.low[0], frame.domain.low[0]), to = std::min(bounds.high[0], frame.domain.high[0]);
        side_ = std::max(bounds.low[1], frame.domain.low[1]);
        width = std::min(bounds.high[1], frame.domain.high[1]) - side_;
        repeats = frame.domain.periodic[1] && width == frame.domain.length(1);
        for (std::size_t i = 0; i < frame.size(); ++i)
            if (frame.state.mobile[i] != 0 && (!newest || frame.id(i) >= frame.newest)) add(powder, frame.state, i);
    }
    [[nodiscard]] bool empty() const { return !(to > from && width > 0); }
    [[nodiscard]] dem::State bed() const {
        dem::State bed;
        for (std::size_t i = 0; frame_->bed != nullptr && i < frame_->bed->position.size(); ++i)
            add(bed, *frame_->bed, i);
        return bed;
    }
    [[nodiscard]] observables::Relief relief(double pitch) const { return {powder, from, to, width, pitch, repeats}; }

private:
    void add(dem::State& into, const dem::State& from, std::size_t i) const {
        const double period = frame_->domain.periodic[1] ? frame_->domain.length(1) : 0;
        const double reach = takes_ == Takes::surfaces ? from.radius[i] : 0;
        double y = from.position[i][1] - side_;
        if (repeats) return append(into, from, i, y);
        if (period > 0) y -= period * std::floor((y + reach) / period);
        for (; y < width + reach; y += period) {
            if (y >= -reach) append(into, from, i, y);
            if (period == 0) return;
        }
    }
    static void append(dem::State& into, const dem::State& from, std::size_t i, double y) {
        into.position.push_back(from.position[i]);
        into.position.back()[1] = y;
        into.velocity.push_back(from.velocity[i]);
        into.radius.push_back(from.radius[i]);
    }

    const Frame* frame_;
    Takes takes_;
    double side_ = 0;
};
using Takes = LayerPart::Takes;

/// Probe of a layer: its options, and a function of them and a frame.
template <double (*value)(const Frame&, const Options&)>
class LayerProbe final : public machine::Probe {
public:
    explicit LayerProbe(const Options& options) : options_(options) {}
    double look(const Frame& frame) override { return value(frame, options_); }

private:
    Options options_;
};

double fraction_of(const Frame& frame, const Options& options) {
    const LayerPart part(frame, options, Takes::centres);
    if (part.empty()) return undefined;
    const double gained = observables::solid_volume(part.powder, part.from, part.to) -
                          observables::solid_volume(part.bed(), part.from, part.to);
    const double fraction = gained / ((part.to - part.from) * part.width * options.number("height"));
    return fraction > options.number("most", 1e300) ? undefined : fraction;
}

double unevenness_of(const Frame& frame, const Options& options) {
    const LayerPart part(frame, options, Takes::centres);
    if (part.empty()) return undefined;
    observables::Patches patches(part.from, part.to, part.width, options.number("side"));
    patches.add(part.powder);
    patches.add(part.bed(), -1);
    return patches.deviation() / (patches.area() * options.number("height"));
}

double bare_share_of(const Frame& frame, const Options& options) {
    const LayerPart part(frame, options, Takes::surfaces, true);
    return part.empty() ? undefined : part.relief(options.number("pitch")).empty_share();
}

double roughness_of(const Frame& frame, const Options& options) {
    const LayerPart part(frame, options, Takes::surfaces);
    // Single particles on a bare base deviate from its height the less, the fewer they are: not a smooth layer.
    if (part.empty() || bare_share_of(frame, options) > options.number("most_bare", 1)) return undefined;
    return part.relief(options.number("pitch")).roughness();
}

/// Mean velocity along x in layers above the lower end of a region, over all frames so far.
class VelocityAbove : public machine::Probe {
public:
    explicit VelocityAbove(const Options& options)
        : selection_(options),
          thickness_(options.number("thickness")),
          profile_(static_cast<std::size_t>(options.number("layers"))) {}
    void restart() override { profile_ = observables::VelocityProfile(profile_.sum.size()), frames_ = 0; }
    double look(const Frame& frame) override {
        dem::State inside;
        selection_.each(frame, [&](std::size_t i) {
            inside.position.push_back(frame.state.position[i]);
            inside.velocity.push_back(frame.state.velocity[i]);
        });
        const Bounds bounds = selection_.region()->bounds();
        profile_.add(inside, bounds.low[0], bounds.high[0], bounds.low[2], thickness_);
        frames_ += 1;
        return undefined;
    }
    void profile(const Frame&, std::vector<Sample>& into) override {
        const auto velocity = velocities();
        for (std::size_t k = 0; k < velocity.size(); ++k)
            into.push_back({.bin = thickness_ * static_cast<double>(k + 1), .value = velocity[k]});
    }
    void save(ByteWriter& out) const override { out.put(profile_.sum), out.put(profile_.samples), out.put(frames_); }
    void restore(ByteReader& in) override {
        const std::size_t layers = profile_.sum.size();
        in.get(profile_.sum), in.get(profile_.samples), in.get(frames_);
        in.require(profile_.sum.size() == layers && profile_.samples.size() == layers);
    }

protected:
    [[nodiscard]] std::vector<double> velocities() const {
        std::vector<double> velocity;
        for (std::size_t k = 0; k < profile_.sum.size(); ++k)
            velocity.push_back(profile_.samples[k] > 0 ? profile_.sum[k] / static_cast<double>(profile_.samples[k])
                                                       : undefined);
        return velocity;
    }
    [[nodiscard]] const std::vector<std::int64_t>& samples() const { return profile_.samples; }
    [[nodiscard]] std::int64_t frames() const { return frames_; }

private:
    Selection selection_;
    double thickness_;
    observables::VelocityProfile profile_;
    std::int64_t frames_ = 0;
};

/// A particle thrown up crosses several layers at one velocity, which would be a false even profile: three neighbouring
/// layers must hold a particle per frame.
class VelocityBend final : public VelocityAbove {
public:
    using VelocityAbove::VelocityAbove;
    double look(const Frame& frame) override {
        static_cast<void>(VelocityAbove::look(frame));
        std::size_t filled = 0, most = 0;
        for (const std::int64_t n : samples()) {
            filled = n >= frames() ? filled + 1 : 0;
            most = std::max(most, filled);
        }
        return most >= 3 ? observables::unevenness(velocities()) : undefined;
    }
};

constexpr Interval above_nothing{0, 1e3, true, false};
constexpr Field part_option =
    option("in", Field::Kind::region, "", "the part of the layer: between the ends of this region along x and y", true);
constexpr Field layer_height_option =
    option("height", Field::Kind::quantity, "m", "height of a full layer", true, above_nothing);
constexpr Field pitch_option =
    option("pitch", Field::Kind::quantity, "m", "of the grid from which the layer is seen", true, above_nothing);
constexpr std::array fraction_options = {
    part_option, layer_height_option,
    option("most", Field::Kind::quantity, "1", "above which it is no packing and undefined; default: none", false,
           positive_number)};
constexpr std::array patch_options = {
    part_option, layer_height_option,
    option("side", Field::Kind::quantity, "m", "of the patches, which are nearly squares", true, above_nothing)};
constexpr std::array bare_options = {part_option, pitch_option};
constexpr std::array relief_options = {
    part_option, pitch_option,
    option("most_bare", Field::Kind::quantity, "1", "bare share above which there is no layer, and it is undefined",
           false, {0, 1})};
constexpr std::array velocity_above_options = {
    option("in", Field::Kind::region, "", "the region, from whose lower end the layers count", true),
    option("thickness", Field::Kind::quantity, "m", "of a layer", true, above_nothing),
    option("layers", Field::Kind::quantity, "1", "their number", true, {3, 1000})};

}  // namespace

ProbeInfo layer_fraction() {
    return probe_row<LayerProbe<fraction_of>>(
        "layer_fraction", "1", "solid volume that a layer has gained, divided by that of a full one", fraction_options);
}
ProbeInfo layer_unevenness() {
    return probe_row<LayerProbe<unevenness_of>>(
        "layer_unevenness", "1", "standard deviation of layer_fraction between patches; undefined below four",
        patch_options);
}
ProbeInfo layer_bare_share() {
    return probe_row<LayerProbe<bare_share_of>>(
        "layer_bare_share", "1", "share of a grid, seen from above, that no particle of the layer covers",
        bare_options);
}
ProbeInfo layer_roughness() {
    return probe_row<LayerProbe<roughness_of>>(
        "layer_roughness", "m", "root mean square deviation of the heights of a layer, seen from above on a grid",
        relief_options);
}
ProbeInfo velocity_above() {
    return probe_row<VelocityAbove>("velocity_above", "m/s",
                                    "mean velocity along x in layers, of all particles of all frames so far",
                                    velocity_above_options, {.over = "top of the layer, m"});
}
ProbeInfo velocity_bend() {
    return probe_row<VelocityBend>(
        "velocity_bend", "m/s",
        "root mean square second difference of velocity_above from layer to layer; undefined where no three "
        "neighbours hold a particle per frame",
        velocity_above_options);
}

}  // namespace grainsweep::machine::probes
