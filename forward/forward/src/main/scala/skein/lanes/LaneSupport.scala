package skein.lanes

import skein.units.Expect

/** Whether this Java can compute by lanes. */
private[skein] object LaneSupport:
  /** A class with vectors is not touched where their module is missing. */
  val present: Either[String, Unit] = Expect.that(
    ModuleLayer.boot().findModule("jdk.incubator.vector").isPresent
  ):
    "the module jdk.incubator.vector is missing; start Java with --add-modules jdk.incubator.vector"

  /** Which engine flies over links, in a line for the user.
    *
    * @param lanes what flies by lanes
    * @param refusals by link, why no lanes fly over it
    * @param otherwise what does then
    */
  def told(lanes: String, refusals: Seq[Option[String]], otherwise: Option[String] = None): String =
    val refused = refusals.flatten
    if refused.isEmpty then s"SIMD, $lanes"
    else if refused.size == refusals.size then otherwise.getOrElse(s"scalar: ${refused.head}")
    else
      s"SIMD, $lanes, over ${refusals.size - refused.size} of ${refusals.size} links; " +
        s"scalar over the others: ${refused.head}"
