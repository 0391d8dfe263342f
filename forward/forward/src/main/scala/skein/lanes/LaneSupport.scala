package skein.lanes

import skein.units.Expect

/** Whether this Java can compute by lanes. */
private[skein] object LaneSupport:
  /** A class with vectors is not touched where their module is missing. */
  val present: Either[String, Unit] = Expect.that(
    ModuleLayer.boot().findModule("jdk.incubator.vector").isPresent
  ):
    "the module jdk.incubator.vector is missing; start Java with --add-modules jdk.incubator.vector"
