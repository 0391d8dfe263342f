package skein.testing

// How a suite is run: `project/TestGroups.scala` reads it from the suite's class file.

/** Measures time: nothing else runs meanwhile. */
trait Timing extends Unhurried

/** Mostly waits, for other programs or for the real clock: runs beside those that compute. */
trait Waiting extends Unhurried

/** Has a JVM of its own, among the first of its module: it takes long, and then runs beside others; or it tells the compilers
  * of its JVM to give way, for good, as is done before a live flight, and on a busy machine everything behind it would be
  * interpreted.
  */
trait Alone extends Unhurried

/** Computes for so long that optimising it pays, or by vectors, which are slow until they are optimised. */
trait Optimised extends Unhurried
