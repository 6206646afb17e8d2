#pragma once
// Attributes for the inner loops: compiled also for wider vector units, chosen by the loader where it can; FLATTEN also
// inlines everything called. Results may differ in the last bits between machines, never between runs or threads.

#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define TENDRIL_CLONES __attribute__((target_clones("arch=haswell", "default")))
#define TENDRIL_FLATTEN_CLONES __attribute__((flatten, target_clones("arch=haswell", "default")))
// For large functions that have a simple twin: compiled for the wider units only, called where `wide_units()` holds.
#define TENDRIL_WIDE __attribute__((flatten, target("avx2,fma")))
namespace tendril::numerics {
inline bool wide_units() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }
}  // namespace tendril::numerics
#else
#define TENDRIL_CLONES
#define TENDRIL_FLATTEN_CLONES
#define TENDRIL_WIDE
namespace tendril::numerics {
inline constexpr bool wide_units() { return false; }
}  // namespace tendril::numerics
#endif
