#include "daemon/supervisor.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace thind {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kOpenFiles = 1024;

struct Pipe {
  Descriptor read_end, write_end;
};

thin::Result<Pipe> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return thin::system_error("make", "a pipe", errno);
  return Pipe{Descriptor(ends[0]), Descriptor(ends[1])};
}

void limit(int resource, std::int64_t value) {
  if (value <= 0) return;
  const rlimit both{static_cast<rlim_t>(value), static_cast<rlim_t>(value)};
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &both);
}

// In the child, between fork and exec: system calls only.
[[noreturn]] void become_worker(char* const* arguments, const WorkerLimits& limits, int output, int errors,
                                pid_t daemon) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != daemon) ::_exit(kExitNotStarted);  // it died before the line above could notice
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  limit(RLIMIT_AS, limits.memory_bytes);
  limit(RLIMIT_CPU, limits.cpu_seconds);
  limit(RLIMIT_FSIZE, limits.file_bytes);
  limit(RLIMIT_NOFILE, kOpenFiles);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(errors, STDERR_FILENO);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGPIPE, SIGCHLD}) ::signal(signal, SIG_DFL);
  sigset_t no_signals;
  ::sigemptyset(&no_signals);
  ::sigprocmask(SIG_SETMASK, &no_signals, nullptr);
  ::execv(arguments[0], arguments);
  const char* why = std::strerror(errno);
  for (const char* text : {"cannot start ", static_cast<const char*>(arguments[0]), ": ", why, "\n"}) {
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) break;
  }
  ::_exit(kExitNotStarted);
}

// Appends what can be read now, but no more than several full pipes of it: a worker that writes without end must not
// hold the daemon. Closes the pipe at its end.
template <class Append>
void drain(Descriptor& pipe, Append append) {
  std::array<char, 65536> block;
  for (int blocks = 0; pipe && blocks < 64; ++blocks) {
    const ssize_t count = ::read(pipe.get(), block.data(), block.size());
    if (count > 0) {
      append(block.data(), static_cast<std::size_t>(count));
    } else if (count < 0 && errno == EINTR) {
      continue;
    } else if (count < 0 && errno == EAGAIN) {
      return;
    } else {
      pipe.close();
    }
  }
}

}  // namespace

Supervisor::~Supervisor() {
  stop_all(SIGKILL);
  for (auto& [key, worker] : workers_) ::waitpid(worker.process, nullptr, 0);
}

thin::Result<Supervisor::Key> Supervisor::start(const WorkerCommand& command) {
  auto output = make_pipe(), errors = make_pipe();
  if (!output) return output.error();
  if (!errors) return errors.error();
  std::vector<char*> arguments;
  for (const std::string& argument : command.arguments) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);

  const pid_t daemon = ::getpid();
  const pid_t process = ::fork();
  if (process < 0) return thin::system_error("start", command.arguments[0], errno);
  if (process == 0)
    become_worker(arguments.data(), command.limits, output->write_end.get(), errors->write_end.get(), daemon);

  ::setpgid(process, process);  // here too: whoever comes first
  Worker worker;
  worker.process = process;
  worker.process_descriptor = Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, process, 0)));
  worker.output = std::move(output->read_end);
  worker.errors = std::move(errors->read_end);
  for (const int pipe : {worker.output.get(), worker.errors.get()}) ::fcntl(pipe, F_SETFL, O_NONBLOCK);
  worker.started = Clock::now();
  worker.deadline = worker.started + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(command.limits.wall_seconds));
  workers_.emplace(++last_key_, std::move(worker));
  return last_key_;
}

void Supervisor::add_to_poll(std::vector<pollfd>& descriptors) const {
  for (const auto& [key, worker] : workers_) {
    for (const Descriptor* each : {&worker.process_descriptor, &worker.output, &worker.errors})
      if (*each) descriptors.push_back({each->get(), POLLIN, 0});
  }
}

std::optional<MonotonicTime> Supervisor::next_deadline() const {
  std::optional<MonotonicTime> next;
  for (const auto& [key, worker] : workers_) {
    // Without a process descriptor (the kernel had none to give) the end is noticed by looking.
    const MonotonicTime look =
        worker.process_descriptor ? worker.deadline : std::min(worker.deadline, Clock::now() + std::chrono::seconds(1));
    if (!next || look < *next) next = look;
  }
  return next;
}

void Supervisor::read_pipes(Worker& worker) {
  drain(worker.output, [&](const char* bytes, std::size_t count) {
    const std::size_t room = kOutputBytes - worker.exit.output.size();
    worker.exit.output_cut |= count > room;
    worker.exit.output.append(bytes, std::min(count, room));
  });
  drain(worker.errors, [&](const char* bytes, std::size_t count) {
    std::string& last = worker.exit.last_errors;
    last.append(bytes, count);
    if (last.size() > kErrorBytes) last.erase(0, last.size() - kErrorBytes);
  });
}

bool Supervisor::reap(Worker& worker) {
  int status = 0;
  const pid_t reaped = ::waitpid(worker.process, &status, WNOHANG);
  if (reaped == 0 || (reaped < 0 && errno == EINTR)) return false;
  ::kill(-worker.process, SIGKILL);  // whatever it has started itself
  if (reaped < 0) {
    worker.exit.last_errors += "\n(its exit status was lost)";
  } else if (WIFEXITED(status)) {
    worker.exit.exit_code = WEXITSTATUS(status);
  } else {
    worker.exit.signal = WTERMSIG(status);
  }
  worker.exit.seconds = std::chrono::duration<double>(Clock::now() - worker.started).count();
  return true;
}

std::vector<std::pair<Supervisor::Key, WorkerExit>> Supervisor::collect() {
  std::vector<std::pair<Key, WorkerExit>> ended;
  for (auto each = workers_.begin(); each != workers_.end();) {
    Worker& worker = each->second;
    if (Clock::now() >= worker.deadline) {
      worker.exit.timed_out = !worker.exit.stopped;
      ::kill(-worker.process, SIGKILL);
    }
    const bool over = reap(worker);
    read_pipes(worker);  // after reaping: then nothing that it said can be missing
    if (over) ended.emplace_back(each->first, std::move(worker.exit));
    each = over ? workers_.erase(each) : std::next(each);
  }
  return ended;
}

void Supervisor::stop_all(int signal) {
  for (auto& [key, worker] : workers_) {
    worker.exit.stopped = true;
    ::kill(-worker.process, signal);
  }
}

thin::Result<WorkerExit> run_worker(const WorkerCommand& command) {
  Supervisor supervisor;
  auto started = supervisor.start(command);
  if (!started) return started.error();
  for (;;) {
    auto ended = supervisor.collect();
    if (!ended.empty()) return std::move(ended.front().second);
    std::vector<pollfd> descriptors;
    supervisor.add_to_poll(descriptors);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(*supervisor.next_deadline() - Clock::now());
    ::poll(descriptors.data(), descriptors.size(), static_cast<int>(std::max<std::int64_t>(left.count(), 1)));
  }
}

}  // namespace thind
