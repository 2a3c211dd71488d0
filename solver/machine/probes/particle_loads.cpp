// Loads of contacts on particles: the sum of the forces, and of the moments about the particles' own centres of mass.
//
// Of several particles together. Contacts between two of them add no force. Weight is not included, so a particle at
// rest bears the opposite of its weight.
#include "solver/machine/contact_place.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

using geometry::cross;
using geometry::operator+;
using geometry::operator*;

constexpr std::array<std::string_view, 3> partner_words = {"all", "particles", "walls"};

/// Contacts of particles that count, with partners of one kind.
class LoadedParticles {
public:
    explicit LoadedParticles(const Options& options) : selection_(options), from_(options.word("from", "all")) {}

    /// Returns the sum of load(contact, sphere, sign) over the spheres that bear a contact, whose force acts on them
    /// times `sign`; undefined if no particle that counts is present.
    template <class Load>
    [[nodiscard]] double sum(const Frame& frame, Load&& load) const {
        if (!any(frame)) return undefined;
        double sum = 0;
        for (const auto& contact : frame.contacts) {
            if (from_ == (contact.second < 0 ? "particles" : "walls")) continue;
            if (holds(frame, contact.first)) sum += load(contact, contact.first, 1.0);
            if (contact.second >= 0 && holds(frame, contact.second)) sum += load(contact, contact.second, -1.0);
        }
        return sum;
    }

private:
    [[nodiscard]] bool any(const Frame& frame) const {
        for (std::size_t i = 0; i < frame.size(); ++i)
            if (selection_.holds(frame, i)) return true;
        return false;
    }
    [[nodiscard]] bool holds(const Frame& frame, std::int32_t sphere) const {
        return selection_.holds(frame, particle_place_of(frame, sphere));
    }

    Selection selection_;
    std::string from_;
};

Vec3 force_of(const dem::ContactForce& contact) {
    return contact.normal_force * contact.normal + contact.tangential_force;
}

/// Returns the moment of a contact about the centre of mass of the particle that a sphere is, or is a member of.
Vec3 moment_on(const Frame& frame, const dem::ContactForce& contact, std::int32_t sphere, double sign) {
    const dem::State& spheres = frame.spheres();
    const std::size_t at = place_of(frame, sphere);
    const double arm = spheres.radius[at] - contact.overlap / 2;
    Vec3 lever = -sign * arm * contact.normal;
    if (frame.members != nullptr) {
        const Vec3& centre = frame.state.position[particle_place_of(frame, sphere)];
        lever = lever + frame.domain.separation(spheres.position[at], centre);
    }
    return sign * (cross(lever, force_of(contact)) + contact.rolling_moment);
}

class ParticleForce final : public machine::Probe {
public:
    explicit ParticleForce(const Options& options) : loaded_(options), along_(options.vector("along")) {}
    double look(const Frame& frame) override {
        return loaded_.sum(frame, [this](const dem::ContactForce& contact, std::int32_t, double sign) {
            return sign * geometry::dot(force_of(contact), along_);
        });
    }

private:
    LoadedParticles loaded_;
    Vec3 along_;
};

class ParticleTorque final : public machine::Probe {
public:
    explicit ParticleTorque(const Options& options) : loaded_(options), axis_(options.vector("axis")) {}
    double look(const Frame& frame) override {
        return loaded_.sum(frame, [&](const dem::ContactForce& contact, std::int32_t sphere, double sign) {
            return geometry::dot(moment_on(frame, contact, sphere, sign), axis_);
        });
    }

private:
    LoadedParticles loaded_;
    Vec3 axis_;
};

constexpr Field partner_option =
    option("from", Field::Kind::word, "", "contacts with 'all', 'particles' or 'walls'; default: 'all'", false, {},
           partner_words);
constexpr std::array particle_force_options = {
    of_option, in_option, option("along", Field::Kind::direction, "", "the direction of the component", true),
    partner_option};
constexpr std::array particle_torque_options = {
    of_option, in_option, option("axis", Field::Kind::direction, "", "the axis, right hand", true), partner_option};

}  // namespace

ProbeInfo particle_force() {
    return probe_row<ParticleForce>("particle_force", "N", "force of contacts on particles, a component",
                                    particle_force_options, {.contacts = true});
}
ProbeInfo particle_torque() {
    return probe_row<ParticleTorque>("particle_torque", "N m",
                                     "moment of contacts on particles about their centres of mass, a component",
                                     particle_torque_options, {.contacts = true});
}

}  // namespace grainsweep::machine::probes
