#include "solver/dem/clear/engine.hpp"
#include "solver/dem/engine.hpp"
#include "solver/dem/fast/mixed_engine.hpp"

namespace grainsweep::dem {

std::unique_ptr<Engine> make_engine(const Setup& setup, const Method& method) {
    require_possible(setup);
    require_possible(setup, method);
    // One line per precision: where an engine joins.
    return method.precision == Method::Precision::mixed
               ? fast::make_mixed_engine(setup, method.path, method.skin, method.rest_speed, {.most = method.threads})
               : clear::make_clear_engine(setup, method);
}

}  // namespace grainsweep::dem
