package skein.lanes

import skein.units.Expect

/** Whether this Java runtime has the vector module that SIMD needs. */
private[skein] object LaneSupport:
  /** Right if the vector module is present; a class with vectors must not be loaded without it. */
  val present: Either[String, Unit] = Expect.that(
    ModuleLayer.boot().findModule("jdk.incubator.vector").isPresent
  ):
    "the module jdk.incubator.vector is missing; start Java with --add-modules jdk.incubator.vector"
