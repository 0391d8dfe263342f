package skein.policy

/** A short way to write the policy of one of two opponents: it chooses a heading from what it knows of its
  * opponent. The vehicle flies at its own speed and the altitude of its start. See
  * [[HeadingPolicy.Memoryless]] for policies without a memory.
  */
trait HeadingPolicy extends Policy:

  /** The heading to command now, rad, from north (+x) towards east (+y), any number of turns; and the memory
    * for the next decision. A pure function.
    */
  def decide(seen: PlanarObservation, memory: Memory): (Double, Memory)

  /** The heading for readings without an age, with the initial memory. */
  final def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double =
    val seen =
      PlanarObservation(dxM, dyM, dvxMps, dvyMps, ownHeadingRad, opponentHeadingRad, elapsedS, 0, 0)
    decide(seen, start)._1

  final override def isAgainstOne: Boolean = true

  final override def isPlanar: Boolean = true

  def choose(seen: Observation, memory: Memory): (Action, Memory) =
    val (heading, next) = decide(PlanarObservation.of(seen), memory)
    (seen.along(heading, seen.cruise.value), next)

object HeadingPolicy:

  /** A heading computed only from the present observation. */
  trait Memoryless extends HeadingPolicy:
    type Memory = Unit

    final def start: Unit = ()

    /** The heading to command now, as [[HeadingPolicy.decide]] chooses it. */
    def heading(seen: PlanarObservation): Double

    final def decide(seen: PlanarObservation, memory: Unit): (Double, Unit) = (heading(seen), memory)
