package skein.identify

import skein.forecast.Structure
import skein.policy.{Action, Axis, SearchSpace}
import skein.signal.{NormalQuantile, SplitMix64}
import skein.units.*
import skein.vehicle.{ObservedPlant, PlaneReading, PlantFlight}

/** The state of a vehicle that must tilt before it accelerates; its readings lack the tilt. */
final case class Tilted(seen: PlaneReading, northMps2: Double, eastMps2: Double)

final case class Tilting(gain: Double, lagS: Double, tiltLagS: Double, override val deadTimeS: Double = 0)
    extends ObservedPlant[Tilted]:
  def initial: Tilted                                      = Tilted(PlaneReading(0, 0, 0, 0), 0, 0)
  def stepS: Double                                        = 0.02
  def read(state: Tilted): PlaneReading                    = state.seen
  def corrected(state: Tilted, seen: PlaneReading): Tilted = state.copy(seen = seen)

  def step(state: Tilted, northMps: Double, eastMps: Double, dtS: Double): Tilted =
    import state.seen
    val share = 1 - StrictMath.exp(-dtS / tiltLagS)
    val north = state.northMps2 + share * ((gain * northMps - seen.northMps) / lagS - state.northMps2)
    val east  = state.eastMps2 + share * ((gain * eastMps - seen.eastMps) / lagS - state.eastMps2)
    Tilted(
      PlaneReading(
        seen.northM + seen.northMps * dtS,
        seen.eastM + seen.eastMps * dtS,
        seen.northMps + north * dtS,
        seen.eastMps + east * dtS
      ),
      north,
      east
    )

/** A user's own structure is fitted like a structure of Skein. */
class OwnStructureSuite extends munit.FunSuite:
  private val structure = Structure(
    "tilting",
    SearchSpace(Vector(Axis("gain", 0.1, 3, 1), Axis("lag-s", 0.1, 5, 1), Axis("tilt-lag-s", 0.05, 2, 0.1))),
    values => Tilting(values(0), values(1), values(2))
  )
  private val truth  = Tilting(gain = 0.9, lagS = 1.4, tiltLagS = 0.5)
  private val values = Vector("gain" -> 0.9, "lag-s" -> 1.4, "tilt-lag-s" -> 0.5)

  /** A minute of flight under commands that turn and change speed, sampled ten times per second with noise.
    */
  private def flown(seed: Long, noiseMps: Double): TimeHistory =
    val source   = SplitMix64(seed)
    def normal() = NormalQuantile(source.nextDouble().max(1e-12).min(1 - 1e-12))
    val arrivals = Vector.tabulate(200): k =>
      val (heading, speed) = (6 * source.nextDouble(), 3 + 8 * source.nextDouble())
      ArrivedCommand(0.05 + 0.3 * k, Action.Along(Radians(heading), MetresPerSecond(speed), Metres(-20)))
    val flight = PlantFlight(truth)
    flight.start(0, truth.initial)
    val samples = Vector.tabulate(600): k =>
      for command <- arrivals if command.atS > 0.1 * (k - 1) && command.atS <= 0.1 * k do
        flight.act(command.atS, command.vx, command.vy)
      flight.advance(0.1 * k)
      val PlaneReading(x, y, vx, vy) = flight.reading
      Sample(
        0.1 * k,
        x + noiseMps / 10 * normal(),
        y + noiseMps / 10 * normal(),
        vx + noiseMps * normal(),
        vy + noiseMps * normal()
      )
    TimeHistory(s"seed $seed", samples, arrivals, -20)

  private def identified(seed: Long, noiseMps: Double): Identification =
    Identification.of(Vector(flown(seed, noiseMps)), structure).fold(fail(_), identity)

  test("without noise the fit finds all parameters, also if readings lack a part of the state"):
    val found = identified(seed = 1, noiseMps = 0)
    for (parameter, (name, value)) <- found.parameters.zip(values) do
      assertEquals(parameter.name, name)
      assertEqualsDouble(parameter.value, value, 1e-3, name)
    val errors = HorizonErrors.of(found.plant, Vector(flown(2, 0)))
    assert(errors.map(_.horizonS) == HorizonErrors.HorizonsS && errors.forall(_.positionP95M < 1e-2), errors)

  test("the 95 % intervals cover the true values in most repetitions with noise"):
    val runs    = 30
    val covered = (1 to runs).flatMap: seed =>
      identified(seed, noiseMps = 0.02).parameters.zip(values).map:
        case (fitted, (name, value)) => (name, fitted.least <= value && value <= fitted.most)
    for (name, hits) <- covered.groupMap(_._1)(_._2) do
      // 24 of 30 or fewer happens with less than 1 in 100 if the coverage is 93 %.
      assert(hits.count(identity) >= 24, s"$name: ${hits.count(identity)} of $runs (seeds 1 to $runs)")

  test("a parameter whose true value is outside its bounds ends at the bound, and is reported as such"):
    val narrow = Structure(
      "narrow",
      SearchSpace(Vector(Axis("gain", 1.2, 3, 2), Axis("lag-s", 0.1, 5, 1))),
      values => Tilting(values(0), values(1), truth.tiltLagS)
    )
    val found = Identification.of(Vector(flown(1, 0)), narrow).fold(fail(_), identity)
    assertEquals(found.parameters.map(_.atBound), Vector(true, false), found.parameters.toString)
