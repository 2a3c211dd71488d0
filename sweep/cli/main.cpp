#include "solver/scenes/scene.hpp"

#include <cstdio>

int main() {
    for (const auto& scene : grainsweep::scene_catalogue()) std::puts(scene.name.c_str());
    return 0;
}
