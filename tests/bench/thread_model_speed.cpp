// Speed of one case against the number of threads: measured as far as this machine has cores, a model beyond.
//
//   bench_thread_model [--figure FILE.svg] [--large]
//
// Model, not measurement: with n threads a particle and step take
//   t(n) = w(n) [c/n + (t(1) - c) B(1)/B(n)],   B(n) = min(n B(1), B_max)
// c: the cost where all data are in caches (a bed of 19,844 spheres), t(1) - c: what memory adds to it, B(1): bandwidth
// of one core here, by the triad a = b + s c of McCalpin's STREAM (1995); B_max: of a socket, 205 GB/s (eight channels
// DDR4-3200) and 461 GB/s (twelve of DDR5-4800), by their data sheets. w(n) is measured here for every n: processor
// time of n threads on the cores there are, over that of one, which holds the pairs that two threads compute both.
// Threads have Threads::least_particles at least. What the model leaves out: the wait at the two barriers of a step,
// about 1 us where cores share a cache, caches that grow with the number of cores, and sockets that are not alike.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "solver/dem/fast/mixed_engine.hpp"
#include "tests/support/granular_beds.hpp"

using namespace grainsweep;

namespace {

constexpr double socket_bandwidths[] = {204.8e9, 460.8e9};  // B/s
constexpr int thread_counts[] = {1, 2, 4, 8, 16, 32, 64};

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
/// Of all threads of this process.
double processor_seconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto of = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return of(used.ru_utime) + of(used.ru_stime);
}

/// Bytes per second of the triad on so many threads, the best of ten passes.
double bandwidth(int threads) {
    constexpr std::size_t length = std::size_t{1} << 24;  // doubles of each array: 128 MB
    std::vector<double> a(length, 1), b(length, 2), c(length, 3);
    double best = 0;
    for (int pass = 0; pass < 10; ++pass) {
        const double start = seconds();
        {
            std::vector<std::jthread> others;
            for (int k = 0; k < threads; ++k)
                others.emplace_back([&, k] {
                    const auto part = [&](int of) {
                        return length * static_cast<std::size_t>(of) / static_cast<std::size_t>(threads);
                    };
                    for (std::size_t i = part(k); i < part(k + 1); ++i) a[i] = b[i] + 0.5 * c[i];
                });
        }
        best = std::max(best, 3.0 * sizeof(double) * static_cast<double>(length) / (seconds() - start));
        std::swap(a, b);
    }
    return best;
}

struct Count {
    int threads = 1;
    double work = 1;      ///< w(n)
    double measured = 0;  ///< times the speed of one thread; 0: more threads than cores
};

struct Scene {
    std::string name;
    double particles = 0;
    double cost = 0;  ///< t(1), s per particle and step
    std::vector<Count> counts;

    /// t(1)/t(n); `cached`: c.
    [[nodiscard]] double model(const Count& count, double cached, double one_core, double socket) const {
        const double memory = std::max(0.0, cost - cached), n = count.threads;
        const double added = memory * one_core / std::min(n * one_core, std::max(socket, one_core));
        return cost / (count.work * ((cost - memory) / n + added));
    }
};

Scene measure(const std::string& name, const dem::Setup& setup) {
    Scene scene{name, static_cast<double>(setup.spheres.size()), 0, {}};
    const auto window = static_cast<std::int64_t>(std::clamp(4e6 / scene.particles, 10.0, 200.0));
    const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    double processor_of_one = 0;
    for (const int n : thread_counts) {
        const auto engine = dem::fast::make_mixed_engine(setup, dem::Method::Path::best, 0, 0, {.most = n});
        engine->run(2 * window);
        double elapsed = 1e300, processor = 1e300;
        for (int k = 0; k < 8; ++k) {
            const double start = seconds(), spent = processor_seconds();
            engine->run(window);
            elapsed = std::min(elapsed, seconds() - start);
            processor = std::min(processor, processor_seconds() - spent);
        }
        if (n == 1) {
            processor_of_one = processor;
            scene.cost = elapsed / (static_cast<double>(window) * scene.particles);
        }
        const double one = scene.cost * static_cast<double>(window) * scene.particles;
        const int used = std::clamp(static_cast<int>(scene.particles / dem::fast::Threads{}.least_particles), 1, n);
        if (used < n) break;
        scene.counts.push_back({n, processor / processor_of_one, n <= cores ? one / elapsed : 0});
    }
    return scene;
}

/// Both axes logarithmic: threads across, times the speed of one thread up.
void draw(const std::vector<Scene>& scenes, double cached, double one_core, const std::filesystem::path& file) {
    const auto x = [](double n) { return 60 + 80 * std::log2(n); };
    const auto y = [](double s) { return 440 - 68 * std::log2(s); };
    std::ofstream out(file);
    out << "<svg xmlns='http://www.w3.org/2000/svg' width='720' height='490' viewBox='0 0 720 490' "
           "font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' fill='#fff'/>\n"
        << "<text x='60' y='20' font-weight='bold'>One case on n threads: measured (dots), model (lines)</text>\n";
    for (const int n : thread_counts) {
        out << fmt::format(
            "<line x1='{0}' x2='{0}' y1='440' y2='{1}' stroke='#ddd'/><text x='{0}' y='458' "
            "text-anchor='middle'>{2}</text>\n<line x1='60' x2='540' y1='{3}' y2='{3}' stroke='#ddd'/>"
            "<text x='52' y='{4}' text-anchor='end'>{2}</text>\n",
            x(n), y(64), n, y(n), y(n) + 4);
    }
    out << "<text x='300' y='480' text-anchor='middle'>threads; times the speed of one thread</text>\n"
        << fmt::format("<line x1='{}' y1='{}' x2='{}' y2='{}' stroke='#999' stroke-dasharray='2 3'/>\n", x(1), y(1),
                       x(64), y(64));
    const char* const colours[] = {"#1663a6", "#c0392b", "#2e8b57"};
    double label = 60;
    for (std::size_t k = 0; k < scenes.size(); ++k) {
        const Scene& scene = scenes[k];
        for (std::size_t socket = 0; socket < std::size(socket_bandwidths); ++socket) {
            std::string points;
            for (const Count& count : scene.counts)
                points += fmt::format("{:.1f},{:.1f} ", x(count.threads),
                                      y(scene.model(count, cached, one_core, socket_bandwidths[socket])));
            out << fmt::format("<polyline fill='none' stroke='{}' {}points='{}'/>\n", colours[k % 3],
                               socket == 0 ? "stroke-dasharray='6 4' " : "", points);
        }
        for (const Count& count : scene.counts)
            if (count.measured > 0)
                out << fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='4' fill='{}'/>\n", x(count.threads),
                                   y(count.measured), colours[k % 3]);
        out << fmt::format("<text x='550' y='{}' fill='{}'>{:.0f} spheres</text>\n", label, colours[k % 3],
                           scene.particles);
        label += 18;
    }
    for (const auto& [dash, words] :
         {std::pair("6 4", "205 GB/s"), std::pair("", "461 GB/s"), std::pair("2 3", "ideal")}) {
        out << fmt::format(
            "<line x1='550' x2='580' y1='{0}' y2='{0}' stroke='#555' stroke-dasharray='{1}'/>"
            "<text x='586' y='{2}'>{3}</text>\n",
            label, dash, label + 4, words);
        label += 18;
    }
    out << "</svg>\n";
}

}  // namespace

int main(int argc, char** argv) {
    std::string figure;
    bool large = false;
    for (int i = 1; i < argc; ++i) {
        if (std::string(argv[i]) == "--figure" && i + 1 < argc) figure = argv[++i];
        if (std::string(argv[i]) == "--large") large = true;
    }
    const double one_core = bandwidth(1);
    fmt::print("{{\"bench\": \"memory\", \"gb_per_s_one\": {:.1f}, \"gb_per_s_two\": {:.1f}}}\n", 1e-9 * one_core,
               1e-9 * bandwidth(2));
    const dem::Setup bed = tests::settled_bed({});
    std::vector<Scene> scenes;
    for (const int across : large ? std::vector{1, 3, 7} : std::vector{1, 3}) {
        scenes.push_back(measure(across == 1   ? "settled_20k"
                                 : across == 3 ? "settled_180k"
                                               : "settled_1M",
                                 tests::replicated(bed, across, across)));
        const double cached = scenes.front().cost;
        for (const Count& count : scenes.back().counts) {
            fmt::print(
                "{{\"bench\": \"thread_model\", \"scene\": \"{}\", \"particles\": {:.0f}, \"threads\": {}, "
                "\"ns_one\": {:.2f}, \"work\": {:.3f}, \"measured\": {:.2f}, \"model_205\": {:.2f}, "
                "\"model_461\": {:.2f}}}\n",
                scenes.back().name, scenes.back().particles, count.threads, 1e9 * scenes.back().cost, count.work,
                count.measured, scenes.back().model(count, cached, one_core, socket_bandwidths[0]),
                scenes.back().model(count, cached, one_core, socket_bandwidths[1]));
        }
        std::fflush(stdout);
    }
    if (!figure.empty()) draw(scenes, scenes.front().cost, one_core, figure);
    return 0;
}
