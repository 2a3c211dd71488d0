// Loads of the powder on walls: force, torque, work, and the pressure of the normal component.
//
// Of several walls together. Means of force, torque and pressure are the impulse divided by its time: integrals over
// every step, which no choice of frames changes. Work: work of the walls' forces on the powder since the start. It does
// not include the work of moments against rolling resistance.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;

struct LoadedWalls : SelectedWalls {
    using SelectedWalls::SelectedWalls;
    /// Returns the sum of a number of their loads; undefined without any.
    template <class Of>
    [[nodiscard]] double sum(const Frame& frame, const Vec3& about, Of&& of) const {
        return SelectedWalls::sum([&](std::size_t w) { return of(frame.engine.wall_load(w, about)); });
    }
};

class Force final : public machine::Probe {
public:
    explicit Force(const Options& options)
        : walls_(options), along_(options.vector("along")), area_(options.number("area", 1)) {}
    double look(const Frame& frame) override {
        return walls_.sum(frame, {}, [this](const dem::WallLoad& load) { return dot(load.force, along_); }) / area_;
    }
    double integral(const Frame& frame) override {
        return walls_.sum(frame, {}, [this](const dem::WallLoad& load) { return dot(load.impulse, along_); }) / area_;
    }

private:
    LoadedWalls walls_;
    Vec3 along_;
    double area_;
};

class Torque final : public machine::Probe {
public:
    explicit Torque(const Options& options)
        : walls_(options), axis_(options.vector("axis")), about_(options.vector("about", {})) {}
    double look(const Frame& frame) override {
        return walls_.sum(frame, about_, [this](const dem::WallLoad& load) { return dot(load.torque, axis_); });
    }
    double integral(const Frame& frame) override {
        return walls_.sum(frame, about_,
                          [this](const dem::WallLoad& load) { return dot(load.angular_impulse, axis_); });
    }

private:
    LoadedWalls walls_;
    Vec3 axis_, about_;
};

class Work final : public machine::Probe {
public:
    explicit Work(const Options& options) : walls_(options) {}
    double look(const Frame& frame) override {
        return walls_.sum(frame, {}, [](const dem::WallLoad& load) { return load.work; });
    }

private:
    LoadedWalls walls_;
};

class RollingTorque final : public machine::Probe {
public:
    explicit RollingTorque(const Options& options) : walls_(options), axis_(options.vector("axis")) {}
    double look(const Frame& frame) override {
        double sum = walls_.none() ? undefined : 0;
        for (const auto& contact : frame.contacts)
            if (walls_.touch(contact)) sum += dot(contact.rolling_moment, axis_);
        return sum;
    }

private:
    SelectedWalls walls_;
    Vec3 axis_;
};

constexpr std::array force_options = {
    walls_option, option("along", Field::Kind::direction, "", "the direction of the component", true)};
constexpr std::array torque_options = {
    walls_option, option("axis", Field::Kind::direction, "", "the axis, right hand", true),
    option("about", Field::Kind::vector, "m", "a point on the axis; default: the origin")};
constexpr std::array rolling_options = {walls_option,
                                        option("axis", Field::Kind::direction, "", "the axis, right hand", true)};
constexpr std::array work_options = {walls_option};
constexpr std::array pressure_options = {
    walls_option, option("along", Field::Kind::direction, "", "the direction of the component", true),
    option("area", Field::Kind::quantity, "m2", "the area that carries it", true, {0, 1e6, true, false})};

/// Of loads whose integral over time the engine keeps.
constexpr ProbeTraits integrated_load{.source = Source::loads};

}  // namespace

ProbeInfo rolling_torque() {
    return probe_row<RollingTorque>("rolling_torque", "N m",
                                    "sum of the moments on particles by which walls resist rolling, about an axis",
                                    rolling_options, {.contacts = true});
}
ProbeInfo wall_force() {
    return probe_row<Force>("wall_force", "N", "force of the powder on walls, a component", force_options,
                            integrated_load);
}
ProbeInfo wall_pressure() {
    return probe_row<Force>("wall_pressure", "Pa", "force of the powder on walls, a component, divided by an area",
                            pressure_options, integrated_load);
}
ProbeInfo wall_torque() {
    return probe_row<Torque>("wall_torque", "N m", "torque of the powder on walls about an axis", torque_options,
                             integrated_load);
}
ProbeInfo wall_work() {
    return probe_row<Work>("wall_work", "J", "work of walls on the powder since the start", work_options,
                           {.source = Source::sums, .so_far = true});
}

}  // namespace grainsweep::machine::probes
