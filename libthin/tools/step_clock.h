#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace thin {

// Wall-clock seconds by step, in the order of the steps.
using StepSeconds = std::vector<std::pair<std::string, double>>;

// Times steps that follow each other: each lasts from the end of the one before it.
class StepClock {
 public:
  explicit StepClock(StepSeconds& seconds) : seconds_(seconds) {}

  void finish(const std::string& step) {
    const auto now = std::chrono::steady_clock::now();
    seconds_.emplace_back(step, std::chrono::duration<double>(now - began_).count());
    began_ = now;
  }

 private:
  StepSeconds& seconds_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace thin
