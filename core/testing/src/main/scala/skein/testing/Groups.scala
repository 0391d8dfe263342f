package skein.testing

// How a suite is run: `project/TestGroups.scala` reads it from the suite's class file.

/** Marks suites that measure time, or change how threads of their JVM are scheduled: no other suite runs
  * meanwhile.
  */
trait Timing extends Unhurried

/** Marks suites that mostly wait, for other programs or for the real clock: they run beside those that
  * compute.
  */
trait Waiting extends Unhurried

/** Marks long suites: whole processes, foreign programs, minutes by the clock. Only `testAll` runs them, each
  * in its own JVM, whose state they may change permanently: before a live flight the JIT compilers get a low
  * priority, and on a busy machine later code would stay interpreted.
  */
trait Lengthy extends Unhurried

/** Marks suites that compute long enough to profit from JIT optimisation, or by vectors, which are slow
  * before it.
  */
trait Optimised extends Unhurried
