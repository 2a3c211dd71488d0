#include "solver/dem/clear/make.hpp"

#include "solver/dem/clear/checkpoint.hpp"
#include "solver/dem/clear/stepping.hpp"
#include "solver/dem/laws/compiled.hpp"

#include <algorithm>

namespace grainsweep::dem::clear {
namespace {

template <class C, Needs needs>
std::unique_ptr<Engine> make(const Setup& setup, const Method& method) {
    return std::make_unique<ClearEngine<typename C::template Contact<double>, needs>>(setup, method);
}

}  // namespace

std::unique_ptr<Engine> make_clear_engine(const Setup& setup, const Method& method) {
    constexpr Needs equal_spheres{}, some_frozen{.frozen = true}, many_sizes{.sizes = true, .frozen = true};
    const auto& spheres = setup.spheres;
    const bool frozen = std::ranges::any_of(spheres, [](const Sphere& s) { return !s.mobile; });
    const bool sizes = std::ranges::any_of(spheres, [&](const Sphere& s) { return s.radius != spheres[0].radius; });
    // Equal spheres without torques are not compiled with frozen ones among them: they take a general combination.
    const int chosen = choose_combination(materials_of(setup), [&](const CombinationFacts& facts) {
        return facts.columns == Columns::any || (sizes ? facts.columns == Columns::sizes : !frozen || facts.spin);
    });
    std::unique_ptr<Engine> engine;
    visit_combination(chosen, Compiled{}, [&]<class C>() {
        if constexpr (C::columns == Columns::any) {
            engine = make<C, many_sizes>(setup, method);
        } else {
            if constexpr (C::columns == Columns::sizes)
                if (sizes) engine = make<C, many_sizes>(setup, method);
            if constexpr (C::template Contact<double>::spin)
                if (!engine && frozen) engine = make<C, some_frozen>(setup, method);
            if (!engine) engine = make<C, equal_spheres>(setup, method);
        }
    });
    return engine;
}

}  // namespace grainsweep::dem::clear
