// Work shared by several threads whose result does not depend on their number: pieces are cut by the data alone, and each
// piece writes what is its own.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace burin {

// What an option `threads` means: 0 is as many as the machine has.
inline int thread_count(int asked) {
    return asked > 0 ? asked : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

// Calls work(i) once for every i in [0, count), on up to `threads` threads (0: see thread_count); returns when all is done.
template <typename Work>
void for_each_piece(std::size_t count, int threads, const Work& work) {
    std::atomic<std::size_t> next{0};
    const auto take = [&] {
        for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::thread> others;
    for (std::size_t t = 1; t < std::min(count, static_cast<std::size_t>(thread_count(threads))); ++t) others.emplace_back(take);
    take();
    for (std::thread& other : others) other.join();
}

// Rows [begin, end) of a picture.
struct Band {
    int begin = 0, end = 0;
    std::size_t index = 0;
};

// Cuts `rows` into `bands` bands of equal height, the last ones smaller or empty, and calls work(band) for each.
template <typename Work>
void for_each_band(int rows, int bands, int threads, const Work& work) {
    const int height = (rows + bands - 1) / bands;
    for_each_piece(static_cast<std::size_t>(bands), threads, [&](std::size_t i) {
        const int begin = std::min(rows, static_cast<int>(i) * height);
        work(Band{begin, std::min(rows, begin + height), i});
    });
}

// The same for bands of 32 rows, for work that keeps nothing between its rows.
template <typename Work>
void for_each_band(int rows, int threads, const Work& work) {
    for_each_band(rows, std::max(1, (rows + 31) / 32), threads, work);
}

}  // namespace burin
