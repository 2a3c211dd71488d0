// List of the compiled combinations of laws, from special to general, for engines, checkpoints and readers of contacts.
// A case uses the first combination that fits its materials.
#pragma once

#include "solver/dem/laws/capillary.hpp"
#include "solver/dem/laws/cohesion.hpp"
#include "solver/dem/laws/constant_torque.hpp"
#include "solver/dem/laws/contact.hpp"
#include "solver/dem/laws/dmt.hpp"
#include "solver/dem/laws/hertz.hpp"
#include "solver/dem/laws/jkr.hpp"
#include "solver/dem/laws/linear.hpp"
#include "solver/dem/laws/mindlin.hpp"
#include "solver/dem/laws/rolling.hpp"

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace grainsweep::dem {

class AnyContact;

/// Spheres for which engines compile a combination.
enum class Columns {
    equal,  ///< equal spheres only, and only materials that need all its laws
    sizes,  ///< as equal, and also spheres of many sizes
    any     ///< any spheres, by the code for many sizes; a law that a material does not need has zero constants
};

template <Columns compiled_for, template <class> class... Laws>
struct Combination {
    static constexpr Columns columns = compiled_for;
    template <class Real>
    using Contact = dem::Contact<Real, Laws...>;

    /// Calls visit with every law.
    template <class Visit>
    static void for_each_law(Visit&& visit) {
        (visit.template operator()<Laws<double>>(), ...);
    }
};

template <class... Combinations>
struct CombinationList {};

using Compiled = CombinationList<Combination<Columns::equal, Hertz>,                                          //
                                 Combination<Columns::sizes, Hertz, Mindlin>,                                 //
                                 Combination<Columns::equal, Hertz, Mindlin, LensCohesion>,                   //
                                 Combination<Columns::any, Hertz, Cohesion, Mindlin>,                         //
                                 Combination<Columns::any, Hertz, Mindlin, ConstantTorque>,                   //
                                 Combination<Columns::any, Hertz, Jkr, Mindlin, RollingResistance>,           //
                                 Combination<Columns::any, Hertz, Jkr, Mindlin, ConstantTorque>,              //
                                 Combination<Columns::any, Hertz, Dmt, Mindlin, RollingResistance>,           //
                                 Combination<Columns::any, Hertz, Dmt, Mindlin, ConstantTorque>,              //
                                 Combination<Columns::any, Hertz, Capillary, Mindlin, RollingResistance>,     //
                                 Combination<Columns::any, Hertz, Capillary, Mindlin, ConstantTorque>,        //
                                 Combination<Columns::sizes, Linear, LinearSliding>,                          //
                                 Combination<Columns::any, Linear, Cohesion, LinearSliding, ConstantTorque>,  //
                                 Combination<Columns::any, Linear, Cohesion, LinearSliding, LinearRolling>,   //
                                 Combination<Columns::any, Hertz, Cohesion, Mindlin, ConstantTorque>,         //
                                 Combination<Columns::any, Hertz, Cohesion, Mindlin, RollingResistance>>;     //

/// Laws that files choose by a word, in the order of their enumerations.
inline constexpr std::array attraction_rows = {sjkr_row, sjkr2_row, paper_row, jkr_row, dmt_row, capillary_row};
inline constexpr std::array resistance_rows = {epsd_row, epsd_liggghts_row, cdt_row};

/// Calls visit.operator()<Combination>() for the combination with number `index`.
template <class Visit, class... Combinations>
void visit_combination(int index, CombinationList<Combinations...>, Visit&& visit) {
    int k = 0;
    ((k++ == index ? visit.template operator()<Combinations>() : void()), ...);
}

/// Properties of a combination that an engine needs before it is chosen.
struct CombinationFacts {
    Columns columns;
    bool spin;
};

/// Returns the number of the first combination that fits all materials of powder and surfaces and for which `compiles`
/// returns true. `compiles` must accept the general ones.
template <class Compiles>
[[nodiscard]] int choose_combination(std::span<const Material> materials, Compiles&& compiles);

[[nodiscard]] bool fits(int combination, std::span<const Material> materials);
[[nodiscard]] int combinations();
[[nodiscard]] CombinationFacts facts_of(int combination);
/// Returns the constants of its laws, in order, in SI.
[[nodiscard]] std::vector<Quantity> constants_of(int combination, const Material& material);
[[nodiscard]] std::unique_ptr<const AnyContact> make_contact(int combination, const Material& material);

/// Number of components of the longest memory.
inline constexpr int memories_at_most = 7;
/// Number of constants of the longest combination.
inline constexpr int constants_at_most = 20;

template <class Compiles>
int choose_combination(std::span<const Material> materials, Compiles&& compiles) {
    for (int k = 0; k < combinations(); ++k)
        if (fits(k, materials) && compiles(facts_of(k))) return k;
    return combinations() - 1;
}

}  // namespace grainsweep::dem
