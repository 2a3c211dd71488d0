#include "solver/dem/clear/engine.hpp"
#include "solver/dem/kinds.hpp"
#include "solver/dem/laws/compiled.hpp"

#include <algorithm>

namespace grainsweep::dem::clear {

std::unique_ptr<Engine> make_clear_engine(const Setup& setup, const Method& method) {
    const bool frozen = std::ranges::any_of(setup.spheres, [](const Sphere& s) { return !s.mobile; });
    const bool sizes = !equally_dense(setup) || radii_of(setup).differ() || !setup.shapes.empty();
    // Equal spheres without torques take a general combination where some are frozen.
    const int chosen = choose_combination(materials_of(setup), [&](const CombinationFacts& facts) {
        return facts.columns == Columns::any || (sizes ? facts.columns == Columns::sizes : !frozen || facts.spin);
    });
    const bool equal = !sizes && facts_of(chosen).columns != Columns::any;
    return std::make_unique<ClearEngine>(setup, method, *make_contact(chosen, setup.material), equal);
}

}  // namespace grainsweep::dem::clear
