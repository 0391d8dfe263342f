package skein.lanes

import skein.forward.RolloutAgent
import skein.lanes.policy.{LanePolicy, PolicyLanes, PolicyNumbers, VehicleNumbers}
import skein.policy.{PlanarObservation, Policy}

/** Policies of one form in many worlds, without vehicles. */
private[skein] object LanePolicies:
  def of(policy: Policy): LanePolicy = LanePolicy(PolicyLanes.get(policy), true)

  extension (lanes: LanePolicy)
    /** Sets a world's policy. */
    def take(world: Int, policy: Policy): Unit =
      val form    = PolicyLanes.get(policy)
      val numbers = PolicyNumbers(form.parametersOf(policy), form.initialOf(policy))
      lanes.put(world, VehicleNumbers(RolloutAgent(0, 0, 0, 0, 0, policy), numbers))

  /** The inputs of the compiled function for the observation and memory of one policy. */
  def inputsOf(seen: PlanarObservation, memory: Any): Array[Double] =
    val (own, known) = (seen.ownHeadingRad, seen.opponentHeadingRad)
    Array(
      seen.dxM,
      seen.dyM,
      seen.dvxMps,
      seen.dvyMps,
      seen.elapsedS,
      StrictMath.cos(own),
      StrictMath.sin(own),
      StrictMath.cos(known),
      StrictMath.sin(known),
      StrictMath.IEEEremainder(own, 2 * math.Pi),
      seen.ownAgeS,
      seen.opponentAgeS
    ) ++ numbersOf(memory)

  private def numbersOf(memory: Any): Vector[Double] = memory match
    case number: Double         => Vector(number)
    case several: Product       => several.productIterator.flatMap(numbersOf).toVector
    case numbers: Array[Double] => numbers.toVector
    case _                      => Vector.empty
