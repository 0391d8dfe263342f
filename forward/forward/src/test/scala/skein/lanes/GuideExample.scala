package skein.lanes

// guide: policy
import skein.policy.{HeadingPolicy, PlanarObservation}

/** The opponent's last bearing, and the mean rate of its change. */
final case class Bearing(rad: Double, rateRadPerS: Double)

/** Leads the opponent by the mean rate of its bearing, with less weight on old readings. */
final case class Lead(gain: Double, forgetS: Double, turnRateRadPerS: Double) extends HeadingPolicy:
  type Memory = Bearing
  def start: Bearing = Bearing(0, 0)

  def decide(seen: PlanarObservation, memory: Bearing): (Double, Bearing) =
    val rad  = StrictMath.atan2(seen.dyM, seen.dxM)
    val rate = if seen.elapsedS > 0 then wrapped(rad - memory.rad) / seen.elapsedS else 0.0
    val news = seen.elapsedS / (seen.elapsedS + forgetS + seen.opponentAgeS)
    val mean = memory.rateRadPerS + news * (rate - memory.rateRadPerS)
    val turn = wrapped(rad - seen.ownHeadingRad) + gain * mean
    val most = turnRateRadPerS * seen.elapsedS
    (seen.ownHeadingRad + turn.max(-most).min(most), Bearing(rad, mean))

  private def wrapped(angleRad: Double) = math.IEEEremainder(angleRad, 2 * math.Pi)
// guide: end

object GuideExample:
  // guide: family
  import skein.policy.{Axis, PolicyFamily, Role, SearchSpace}

  val leads = PolicyFamily(
    "lead",
    "leads by the bearing's average rate",
    Set(Role.Pursuer),
    SearchSpace(
      Vector(Axis("gain", 0, 4), Axis("forgetS", 0.05, 2), Axis("turnRateRadPerS", 0.5, 2))
    ),
    numbers => Lead(numbers(0), numbers(1), numbers(2))
  )
  // guide: end

  // guide: search
  import skein.forward.{DelayTable, Engagement, LoopTiming, VelocityResponses}
  import skein.lanes.{TeamBatch, TeamCandidate}
  import skein.optimise.{Direction, DistanceTerm, Objective, TeamEvaluator}
  import skein.scenario.PaperDuel

  val duel    = Engagement.of(PaperDuel().fleet, durationS = 60)
  val timing  = LoopTiming.Stream()
  val lag     = VelocityResponses.lag(gain = 0.9, lagS = 0.8, deadTimeS = 0.05)
  val nearest = Objective(Vector(1.0 -> DistanceTerm.Last10s), Direction.Minimise)

  def candidate(parameters: Vector[Double]): TeamCandidate =
    TeamCandidate(duel.flownBy(Role.Pursuer, leads.policy(parameters)), nearest.judged(60, timing.periodS))

  val evaluator  = TeamEvaluator(TeamBatch(timing, lag), candidate, DelayTable.vpn, nearest, seed = 1)
  val candidates = leads.space.random(200, seed = 1)
  val best       = candidates.zip(evaluator.tallies(candidates, 0 until 20)).minBy(_._2.mean)
  // guide: end

  // guide: vehicle
  import skein.vehicle.{PlaneReading, Plant}

  /** Follows the commanded velocity with a first-order lag. */
  final case class Lagging(gain: Double, lagS: Double) extends Plant[PlaneReading]:
    def initial: PlaneReading                   = PlaneReading(0, 0, 0, 0)
    def stepS: Double                           = 0.1
    def read(state: PlaneReading): PlaneReading = state

    def step(state: PlaneReading, northMps: Double, eastMps: Double, dtS: Double): PlaneReading =
      val left          = StrictMath.exp(-dtS / lagS)
      val (north, east) = (state.northMps - gain * northMps, state.eastMps - gain * eastMps)
      PlaneReading(
        state.northM + gain * northMps * dtS + north * lagS * (1 - left),
        state.eastM + gain * eastMps * dtS + east * lagS * (1 - left),
        gain * northMps + north * left,
        gain * eastMps + east * left
      )
  // guide: end
