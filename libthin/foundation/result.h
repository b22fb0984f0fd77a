#pragma once

// Failure in the type, for everything that bytes, files and configurations can get wrong. A caller's own mistakes are
// assertions instead.

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace thin {

enum class ErrorKind {
  configuration,  // the configuration or the command line is wrong; nothing was done
  input,          // this input can't be used, now or ever; the rest can go on
  incomplete,     // this input may still be arriving: a cut end, an open transfer
  temporary,      // the machine's making (disk full, I/O error): wait and try again
  internal,       // none of the above
};

struct Error {
  ErrorKind kind = ErrorKind::internal;
  std::string message;  // one sentence or two: what, where, which value, and the remedy
};

// Exit status of the programs (docs/operations.md): 0 done, 1 other, 2 configuration, 3 done with quarantined inputs,
// 75 temporary.
constexpr int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::configuration:
      return 2;
    case ErrorKind::input:
      return 3;
    case ErrorKind::incomplete:
    case ErrorKind::temporary:
      return 75;
    case ErrorKind::internal:
      return 1;
  }
  return 1;
}

// The kind of error that a failed system call with this errno is: temporary for what the machine may get over
// (ENOSPC, EDQUOT, EIO, EMFILE, ENFILE, ENOMEM, EAGAIN), internal otherwise.
ErrorKind kind_of_errno(int error_number);

// Error for a failed system call on a path: "cannot open /a/b: No space left on device".
Error system_error(const std::string& what, const std::string& path, int error_number);

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  // REQUIRES: ok()
  T& value() & { return assert(ok()), *std::get_if<0>(&state_); }
  const T& value() const& { return assert(ok()), *std::get_if<0>(&state_); }
  T&& value() && { return assert(ok()), std::move(*std::get_if<0>(&state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  // REQUIRES: !ok()
  const Error& error() const { return assert(!ok()), std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}

  bool ok() const { return !error_; }
  explicit operator bool() const { return ok(); }

  // REQUIRES: !ok()
  const Error& error() const { return assert(error_), error_.value(); }

 private:
  std::optional<Error> error_;
};

}  // namespace thin
