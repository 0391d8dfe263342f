package skein.lanes

import skein.units.Expect

/** Checks whether this Java runtime has the vector module that SIMD requires. */
private[skein] object LaneSupport:
  /** Right if the vector module is present. Without it, no class that uses vectors may be loaded. */
  val present: Either[String, Unit] = Expect.that(
    ModuleLayer.boot().findModule("jdk.incubator.vector").isPresent
  ):
    "the module jdk.incubator.vector is missing; start Java with --add-modules jdk.incubator.vector"
