// Statistics of the contacts between particles: the sizes of normal forces, and the directions of normals.
//
// Of f/<f>, f the size of the normal force and <f> its mean over the contacts of a frame, the profile is the
// probability density. Fabric (Satake 1982): F_ab = <n_a n_b> over the contacts, trace 1;
//
//     component along a direction e: e.F.e, 1/3 in an isotropic bed
//     anisotropy = sqrt(3/2 F'_ab F'_ab), F' = F less its trace: 0 isotropic, 1/2 all in a plane, 1 all parallel
#include "solver/machine/binning.hpp"
#include "solver/machine/contact_place.hpp"
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <cmath>

namespace grainsweep::machine::probes {
namespace {

/// Calls visit(contact) for contacts of two particles that count: of the species both, in the region the contact.
class ContactSelection {
public:
    explicit ContactSelection(const Options& options) : of_(options.numbers("of")), in_(options.region("in")) {}
    template <class Visit>
    void each(const Frame& frame, Visit&& visit) const {
        for (const auto& contact : frame.contacts)
            if (contact.second >= 0 && of_these(frame, contact.first) && of_these(frame, contact.second) &&
                (!in_ || in_->contains(contact_point(frame, contact))))
                visit(contact);
    }

private:
    [[nodiscard]] bool of_these(const Frame& frame, std::int32_t id) const {
        return of_.empty() || std::ranges::find(of_, frame.species[static_cast<std::size_t>(id)]) != of_.end();
    }
    std::vector<std::size_t> of_;
    std::optional<Region> in_;
};

constexpr double largest_ratio = 6;

template <bool density>
class ContactForces final : public machine::Probe {
public:
    explicit ContactForces(const Options& options)
        : selection_(options), bins_{0, options.number("to", largest_ratio), bins_in(options)} {}
    double look(const Frame& frame) override {
        forces_.clear();
        mean_ = 0;
        selection_.each(frame, [&](const dem::ContactForce& c) { forces_.push_back(std::abs(c.normal_force)); });
        for (const double f : forces_) mean_ += f / static_cast<double>(forces_.size());
        return forces_.empty() || density ? undefined : mean_;
    }
    void profile(const Frame&, std::vector<Sample>& into) override {
        std::vector<double> numbers(bins_.count, 0.0);
        for (const double f : forces_)
            if (const std::size_t bin = bins_.at(f / mean_); bin < bins_.count) numbers[bin] += 1;
        for (std::size_t b = 0; b < bins_.count; ++b)
            into.push_back(
                {.bin = bins_.centre(b), .value = numbers[b] / (static_cast<double>(forces_.size()) * bins_.width())});
    }

private:
    ContactSelection selection_;
    Bins bins_;
    std::vector<double> forces_;  // N, of the last look
    double mean_ = 0;
};

class Fabric final : public machine::Probe {
public:
    explicit Fabric(const Options& options)
        : selection_(options), component_(options.has("along")), along_(options.vector("along", {})) {}
    double look(const Frame& frame) override {
        double contacts = 0, parallel = 0;
        std::array<Vec3, 3> sum{};
        selection_.each(frame, [&](const dem::ContactForce& c) {
            ++contacts;
            const double share = geometry::dot(c.normal, along_);
            parallel += share * share;
            for (std::size_t a = 0; a < 3; ++a)
                for (std::size_t b = 0; b < 3; ++b) sum[a][b] += c.normal[a] * c.normal[b];
        });
        if (contacts == 0) return undefined;
        if (component_) return parallel / contacts;
        double squares = 0;
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b) {
                const double f = sum[a][b] / contacts - (a == b ? 1.0 / 3 : 0);
                squares += f * f;
            }
        return std::sqrt(1.5 * squares);
    }

private:
    ContactSelection selection_;
    bool component_;
    Vec3 along_;
};

constexpr Field both_of_option =
    option("of", Field::Kind::species, "", "the species both particles are of; default: all");
constexpr Field contact_in_option =
    option("in", Field::Kind::region, "", "the region in which contacts count; default: everywhere");
constexpr std::array contact_force_options = {both_of_option, contact_in_option};
constexpr std::array contact_density_options = {
    both_of_option, contact_in_option,
    option("to", Field::Kind::quantity, "1", "the force where the last bin ends, divided by the mean; default: 6",
           false, {0, 1e6, true, false}),
    bins_option};
constexpr std::array fabric_options = {
    both_of_option, contact_in_option,
    option("along", Field::Kind::direction, "", "the component along it; default: the anisotropy")};

std::string flaw_of_contact_density(const Options& given) {
    return flaw_of_bins(given, 0, given.number("to", largest_ratio));
}

}  // namespace

ProbeInfo contact_force() {
    return {"contact_force",
            "N",
            "mean size of the normal force between particles",
            contact_force_options,
            make_probe<ContactForces<false>>,
            true};
}
ProbeInfo contact_force_density() {
    return {"contact_force_density",
            "1",
            "probability density of normal forces divided by their mean",
            contact_density_options,
            make_probe<ContactForces<true>>,
            true,
            "force divided by the mean force",
            flaw_of_contact_density};
}
ProbeInfo fabric() {
    return {"fabric",
            "1",
            "anisotropy of the directions of contacts between particles, 0 to 1, or a component of their fabric tensor",
            fabric_options,
            make_probe<Fabric>,
            true};
}

}  // namespace grainsweep::machine::probes
