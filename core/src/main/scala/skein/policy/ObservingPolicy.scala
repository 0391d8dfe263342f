package skein.policy

import skein.units.Radians

/** What an [[ObservingPolicy]] sees of its opponent. North and east, m and m/s; the first seven are the
  * arguments of [[Policy.heading]].
  *
  * @param ownAgeS how old the reading of the own vehicle is, s
  * @param opponentAgeS the same of the opponent's
  */
final case class PlanarObservation(
    dxM: Double,
    dyM: Double,
    dvxMps: Double,
    dvyMps: Double,
    ownHeadingRad: Double,
    opponentHeadingRad: Double,
    elapsedS: Double,
    ownAgeS: Double,
    opponentAgeS: Double
):
  /** What learners see, in the frame whose x-axis is the own heading commanded last: the opponent's place
    * ahead and to the right, m; its velocity minus the own one, m/s; cosine and sine of its heading from the
    * own one; the time since the own last decision, the age of the own reading and of the opponent's, s.
    */
  def fromOwnHeading: Array[Double] =
    val cos     = StrictMath.cos(ownHeadingRad)
    val sin     = StrictMath.sin(ownHeadingRad)
    val bearing = opponentHeadingRad - ownHeadingRad
    val into    = Array.ofDim[Double](9)
    into(0) = dxM * cos + dyM * sin
    into(1) = dyM * cos - dxM * sin
    into(2) = dvxMps * cos + dvyMps * sin
    into(3) = dvyMps * cos - dvxMps * sin
    into(4) = StrictMath.cos(bearing)
    into(5) = StrictMath.sin(bearing)
    into(6) = elapsedS
    into(7) = ownAgeS
    into(8) = opponentAgeS
    into

object PlanarObservation:
  def of(seen: Observation): PlanarObservation =
    val (own, opponent) = (seen.own, seen.vehicles(seen.opponent))
    val toOpponent      = opponent.kinematics.positionNed - own.kinematics.positionNed
    val closing         = opponent.kinematics.velocityNed - own.kinematics.velocityNed
    PlanarObservation(
      toOpponent.x,
      toOpponent.y,
      closing.x,
      closing.y,
      seen.headings(seen.self).value,
      seen.headings(seen.opponent).value,
      seen.elapsed.toSeconds,
      own.age.toSeconds,
      opponent.age.toSeconds
    )

/** @param memory what the policy is given at its next decision
  */
final case class Decided[M](headingRad: Double, memory: M)

/** A policy with a memory of its own, who is told how old what it sees is. As a [[Policy]] it is a pure
  * function.
  *
  * It flies by lanes if [[decide]] is arithmetic and the memory is a number or a case class of numbers.
  *
  * @tparam M what it remembers
  */
trait ObservingPolicy[M] extends Policy:

  /** What it remembers before its first decision. */
  def initial: M

  /** The heading to command now, and what to remember. */
  def decide(seen: PlanarObservation, memory: M): Decided[M]

  final override def start: Any = initial

  final override def planar(seen: Observation, memory: Any): (Planar, Any) =
    val decided = decide(PlanarObservation.of(seen), memory.asInstanceOf[M])
    (Planar(Radians(decided.headingRad), None), decided.memory)

  /** As a first decision, on readings of now. */
  final def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double =
    decide(
      PlanarObservation(dxM, dyM, dvxMps, dvyMps, ownHeadingRad, opponentHeadingRad, elapsedS, 0, 0),
      initial
    ).headingRad

object ObservingPolicy:

  /** Decides by a policy of either kind.
    *
    * @param memory the policy's own; anything where it has none
    * @return and what it remembers
    */
  def decide(policy: Policy, seen: PlanarObservation, memory: Any): Decided[Any] = policy match
    case observing: ObservingPolicy[m] =>
      val decided = observing.decide(seen, memory.asInstanceOf[m])
      Decided(decided.headingRad, decided.memory)
    case plain =>
      Decided(
        plain.heading(
          seen.dxM,
          seen.dyM,
          seen.dvxMps,
          seen.dvyMps,
          seen.ownHeadingRad,
          seen.opponentHeadingRad,
          seen.elapsedS
        ),
        memory
      )

  /** What a policy remembers before its first decision; nothing where it has no memory. */
  def initialOf(policy: Any): Any = policy match
    case observing: ObservingPolicy[?] => observing.initial
    case _                             => ()
