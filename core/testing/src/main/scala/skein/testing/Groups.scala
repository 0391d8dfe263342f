package skein.testing

// `project/TestGroups.scala` reads from a suite's class file how it is run.

/** Marks suites that measure time or change how threads of their JVM are scheduled; they run alone. */
trait Timing extends Unhurried

/** Marks suites that mostly wait for other programs or for the real clock; they run concurrently with suites
  * that compute.
  */
trait Waiting extends Unhurried

/** Marks long suites, which start processes or external programs, or take minutes. Only `testAll` runs them,
  * each in its own JVM, because they may change its state permanently: before a live flight the JIT compilers
  * get a low priority, and on a busy machine later code would stay interpreted.
  */
trait Lengthy extends Unhurried

/** Marks suites that compute for long enough to profit from JIT optimisation, or that use vectors, which are
  * slow without it.
  */
trait Optimised extends Unhurried
