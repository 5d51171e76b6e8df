// Work on parts of a map by several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace burin::refinement {

// Runs work(part) for every part; which thread takes which must not matter. `threads` 0: as many as the machine has.
template <typename Work>
void in_parallel(int parts, int threads, Work work) {
    if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    threads = std::min(threads, parts);
    std::atomic<int> next{0};
    const auto run = [&] {
        for (int part = next++; part < parts; part = next++) work(part);
    };
    std::vector<std::thread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(run);
    run();
    for (std::thread& thread : others) thread.join();
}

}  // namespace burin::refinement
