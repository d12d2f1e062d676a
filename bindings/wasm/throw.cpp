/// wasm32-wasi throws no exceptions: `throw` hands the message to the page instead, which raises it
/// as an error of JavaScript and leaves the call. What the C++ side was about to build is lost; what
/// stood before is untouched.
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <typeinfo>

extern "C" {

__attribute__((import_module("env"), import_name("fail"), noreturn)) void fail(const char* text,
                                                                               std::size_t length);

void* __cxa_allocate_exception(std::size_t size) noexcept { return std::malloc(size); }
void __cxa_free_exception(void* thrown) noexcept { std::free(thrown); }

/// Everything this library throws is a std::exception, at its start.
[[noreturn]] void __cxa_throw(void* thrown, std::type_info*, void (*)(void*)) {
  const char* text = static_cast<std::exception*>(thrown)->what();
  fail(text, std::strlen(text));
}
}
