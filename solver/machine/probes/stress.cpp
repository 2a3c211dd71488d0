// Stress in a region, or in slabs along a direction; compression is positive.
//
//     s_ab = 1/V (sum over contacts of f_a l_b w + sum over particles of m v'_a v'_b)
//
// f: force on one partner; l: vector to its centre from the centre of the other partner, from the surface of a wall, or
// from the contact with a glued particle. w: share of l in the region, counted in equal pieces. v': velocity relative
// to the mean by mass of the region. Goldhirsch (2010), Granul. Matter 12, 239, eqs. 36 and 37, with the region as
// coarse- graining function; walls as Weinhart, Thornton, Luding & Bokhove (2012), Granul. Matter 14, 289. Exact where
// a region holds all of a contact; of a contact across its border w errs by at most half a piece.
//
//     pressure = (s_xx + s_yy + s_zz)/3,   deviator = sqrt(3/2 s'_ab s'_ab), s' without the pressure, symmetric
#include "solver/machine/binning.hpp"
#include "solver/machine/contact_place.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <cmath>

namespace grainsweep::machine::probes {
namespace {

using geometry::dot;
using geometry::operator+;
using geometry::operator-;
using geometry::operator*;
using geometry::operator+=;

constexpr int pieces = 32;  // of a contact

struct Tensor {
    std::array<Vec3, 3> row{};

    /// Adds a b to it.
    void add(const Vec3& a, const Vec3& b) {
        for (std::size_t k = 0; k < 3; ++k) row[k] += a[k] * b;
    }
    [[nodiscard]] double trace() const { return row[0][0] + row[1][1] + row[2][2]; }
    [[nodiscard]] double along(const Vec3& a, const Vec3& b) const {
        return a[0] * dot(row[0], b) + a[1] * dot(row[1], b) + a[2] * dot(row[2], b);
    }
    [[nodiscard]] double deviator() const {
        double squares = 0;
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b) {
                const double s = (row[a][b] + row[b][a]) / 2 - (a == b ? trace() / 3 : 0);
                squares += s * s;
            }
        return std::sqrt(1.5 * squares);
    }
};

/// Sums of a region or a slab.
struct Held {
    Tensor contacts, flux;
    double mass = 0;
    Vec3 momentum{};
};

class Stress final : public machine::Probe {
public:
    explicit Stress(const Options& options)
        : in_(options.region("in")),
          along_(options.vector("along", {})),
          bins_(bins_along(options)),
          quantity_(options.word("quantity", "pressure")),
          force_(options.vector("force", {})),
          face_(options.vector("face", {})) {
        const auto part = options.word("part", "all");
        of_contacts_ = part != "kinetic", of_motion_ = part != "contact";
        volume_ = bins_.count > 0 ? options.number("section") * bins_.width() : *in_->volume();
    }

    double look(const Frame& frame) override {
        fill(frame);
        return bins_.count > 0 ? undefined : value(held_.front(), volume_);
    }
    void profile(const Frame&, std::vector<Sample>& into) override {
        append_bins(into, bins_, [this](std::size_t b) { return value(held_[b], volume_); });
    }

private:
    void fill(const Frame& frame) {
        held_.assign(std::max<std::size_t>(bins_.count, 1), {});
        for (std::size_t i = 0; of_motion_ && i < frame.size(); ++i) {
            Held* const held = frame.state.mobile[i] != 0 ? holding(frame.state.position[i]) : nullptr;
            if (held == nullptr) continue;
            held->mass += frame.mass(i);
            held->momentum += frame.mass(i) * frame.state.velocity[i];
            held->flux.add(frame.mass(i) * frame.state.velocity[i], frame.state.velocity[i]);
        }
        for (std::size_t k = 0; of_contacts_ && k < frame.contacts.size(); ++k) add(frame, frame.contacts[k]);
    }
    void add(const Frame& frame, const dem::ContactForce& contact) {
        const dem::State& state = frame.spheres();
        const std::size_t i = place_of(frame, contact.first);
        if (frame.members != nullptr) return add_by_particles(frame, contact);
        // From the centre of the first partner towards the other one: where the contact begins and ends.
        double begin = 0, end = state.radius[i] - contact.overlap;
        if (contact.second >= 0) {
            const std::size_t j = place_of(frame, contact.second);
            if (state.mobile[i] == 0) begin = state.radius[i] - contact.overlap / 2;
            end += state.mobile[j] == 0 ? contact.overlap / 2 : state.radius[j];
        }
        const Vec3 force = contact.normal_force * contact.normal + contact.tangential_force;
        const Vec3 piece = ((end - begin) / pieces) * contact.normal;
        for (int p = 0; p < pieces; ++p) {
            const Vec3 x = state.position[i] - begin * contact.normal - (p + 0.5) * piece;
            if (Held* const held = holding(x + frame.domain.wrapping(x))) held->contacts.add(force, piece);
        }
    }
    /// Adds a contact where there are clumps: from the centre of mass of one partner to the contact, and on to that of
    /// the other. What does not move begins at the contact.
    void add_by_particles(const Frame& frame, const dem::ContactForce& contact) {
        const Vec3 force = contact.normal_force * contact.normal + contact.tangential_force;
        const Vec3 point = contact_point(frame, contact);
        const auto add_way = [&](std::int32_t id, double sign) {
            const std::size_t p = particle_place_of(frame, id);
            if (frame.state.mobile[p] == 0) return;
            const Vec3 way = frame.domain.separation(point, frame.state.position[p]);
            const Vec3 piece = (sign / pieces) * way;
            for (int k = 0; k < pieces; ++k) {
                const Vec3 x = point - ((k + 0.5) / pieces) * way;
                if (Held* const held = holding(x + frame.domain.wrapping(x))) held->contacts.add(force, piece);
            }
        };
        add_way(contact.first, -1);
        if (contact.second >= 0) add_way(contact.second, 1);
    }
    [[nodiscard]] Held* holding(const Vec3& x) {
        if (in_ && !in_->contains(x)) return nullptr;
        if (bins_.count == 0) return held_.data();
        const std::size_t bin = bins_.at(dot(x, along_));
        return bin < bins_.count ? &held_[bin] : nullptr;
    }
    [[nodiscard]] double value(const Held& held, double volume) const {
        Tensor s = held.contacts;
        for (std::size_t k = 0; k < 3; ++k) s.row[k] += held.flux.row[k];
        if (held.mass > 0) s.add((-1 / held.mass) * held.momentum, held.momentum);
        const double of = quantity_ == "pressure"   ? s.trace() / 3
                          : quantity_ == "deviator" ? s.deviator()
                                                    : s.along(force_, face_);
        return of / volume;
    }

    std::optional<Region> in_;
    Vec3 along_;
    Bins bins_;
    std::string quantity_;
    Vec3 force_, face_;
    bool of_contacts_ = true, of_motion_ = true;
    double volume_ = 0;       // of the region, or a slab, m3
    std::vector<Held> held_;  // by slab; of a region one
};

std::string flaw_of_component(const Options& given) {
    const bool component = given.word("quantity", "pressure") == "component";
    return given.has("force") == component && given.has("face") == component
               ? ""
               : "the quantity 'component', and no other, has \"force\" and \"face\"";
}
std::string flaw_of_stress(const Options& given) {
    return given.region("in")->volume() ? flaw_of_component(given)
                                        : "a stress needs a region with a volume: a box, cylinder or ball";
}
std::string flaw_of_stress_profile(const Options& given) {
    const std::string flaw = flaw_of_bins_along(given);
    return flaw.empty() ? flaw_of_component(given) : flaw;
}

constexpr std::array<std::string_view, 3> stress_quantities = {"pressure", "deviator", "component"};
constexpr std::array<std::string_view, 3> stress_parts = {"all", "contact", "kinetic"};
constexpr Field stress_quantity =
    option("quantity", Field::Kind::word, "", "'pressure', 'deviator' (von Mises) or 'component'; default: pressure",
           false, {}, stress_quantities);
constexpr Field stress_force =
    option("force", Field::Kind::direction, "", "of a component: the direction of the force");
constexpr Field stress_face =
    option("face", Field::Kind::direction, "", "of a component: the normal of the face it acts on");
constexpr Field stress_part =
    option("part", Field::Kind::word, "",
           "'all', 'contact': by forces, 'kinetic': by motion about the mean; default: all", false, {}, stress_parts);
constexpr std::array stress_options = {
    option("in", Field::Kind::region, "", "the region: a box, cylinder or ball", true), stress_quantity, stress_force,
    stress_face, stress_part};
constexpr std::array stress_profile_options = {
    option("in", Field::Kind::region, "", "what bounds the slabs; default: nothing"),
    option("along", Field::Kind::direction, "", "the direction across the slabs", true),
    option("from", Field::Kind::quantity, "m", "where the first slab begins", true),
    option("to", Field::Kind::quantity, "m", "where the last slab ends", true),
    option("section", Field::Kind::quantity, "m2", "area of a slab", true, {0, 1e6, true, false}),
    bins_option,
    stress_quantity,
    stress_force,
    stress_face,
    stress_part};

}  // namespace

ProbeInfo stress() {
    return probe_row<Stress>("stress", "Pa", "stress of the powder in a region, compression positive", stress_options,
                             {.contacts = true, .flaw = flaw_of_stress});
}
ProbeInfo stress_profile() {
    return probe_row<Stress>("stress_profile", "Pa", "the same in slabs across a direction", stress_profile_options,
                             {.contacts = true, .over = "centre of the slab, m", .flaw = flaw_of_stress_profile});
}

}  // namespace grainsweep::machine::probes
