// Contacts of a bed: the mean numbers of partners and of contacts, and the deepest overlap.
//
// A clump touches a partner once or at several of its spheres: it counts once as a partner, and each place as a
// contact.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

#include <set>
#include <utility>

namespace grainsweep::machine::probes {
namespace {

template <bool each_contact>
double contacts_per_particle(const Frame& frame, const Selection& selection) {
    std::vector<char> counts(frame.species.size(), 0);
    double particles = 0, partners = 0;
    selection.each(frame, [&](std::size_t i) {
        counts[frame.id(i)] = 1;
        ++particles;
    });
    std::set<std::pair<std::int32_t, std::int32_t>> met;  // of clumps
    for (const auto& contact : frame.contacts) {
        if (contact.second < 0) continue;
        const std::int32_t a = frame.particle_of(contact.first), b = frame.particle_of(contact.second);
        if (!each_contact && frame.members != nullptr && !met.insert(std::minmax(a, b)).second) continue;
        partners += counts[static_cast<std::size_t>(a)] + counts[static_cast<std::size_t>(b)];
    }
    return particles > 0 ? partners / particles : undefined;
}

class Overlap final : public machine::Probe {
public:
    explicit Overlap(const Options& options) : over_steps_(options.word("over", "frames") == "steps") {}
    double look(const Frame& frame) override {
        return over_steps_ ? frame.peak_overlap : frame.engine.largest_overlap();
    }

private:
    bool over_steps_;
};

constexpr std::array contacts_options = {of_option, in_option};
constexpr std::array<std::string_view, 2> over_words = {"frames", "steps"};
constexpr std::array overlap_options = {
    option("over", Field::Kind::word, "",
           "'frames': now, 'steps': the deepest at any step since the phase began; default: "
           "'frames'",
           false, {}, over_words)};

}  // namespace

ProbeInfo coordination() {
    return probe_row<SelectionProbe<contacts_per_particle<false>>>(
        "coordination", "1", "mean number of other particles that a particle touches", contacts_options,
        {.contacts = true});
}
ProbeInfo contact_number() {
    return probe_row<SelectionProbe<contacts_per_particle<true>>>(
        "contacts", "1", "mean number of contacts of a particle with others; a clump may touch one at several spheres",
        contacts_options, {.contacts = true});
}
ProbeInfo overlap() {
    return probe_row<Overlap>(
        "overlap", "1", "deepest overlap of two particles divided by the diameter of the smaller one", overlap_options);
}

}  // namespace grainsweep::machine::probes
