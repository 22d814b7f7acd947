#pragma once
// The heap's free pages. What lies between long-lived keyframes stays resident until it is asked
// back for.

namespace rovigo::slam {

/// Returns the free pages of glibc's heap to the system; elsewhere it does nothing.
void give_back_free_memory();

}  // namespace rovigo::slam
