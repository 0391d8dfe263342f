package skein.vehicle

import java.util.concurrent.atomic.AtomicLong
import skein.signal.SplitMix64
import skein.units.Vector3

/** Differences of the simulated quadrotor and its air from AirSim's in still air, which models and predictors
  * assume.
  *
  * @param mass factor on the mass
  * @param drag factor on the drag
  * @param lag factor on the lag of the velocity; divides the gain from velocity to tilt
  * @param rotors share of its control that each rotor performs: front right, rear left, front left, rear
  *   right
  */
final case class Deviation(
    mass: Double = 1,
    drag: Double = 1,
    lag: Double = 1,
    rotors: Vector[Double] = Vector.fill(4)(1.0),
    wind: Wind = Wind.None
):
  def quadrotor: Quadrotor =
    val airframe = Airframe()
    val gains    = ControllerGains()
    Quadrotor(
      airframe.copy(massKg = airframe.massKg * mass, dragCoefficient = airframe.dragCoefficient * drag),
      gains.copy(velocityP = gains.velocityP / lag)
    )

  /** A kind of vehicle with these deviations, each vehicle with its own gusts. */
  def kind(seed: Long): RotorcraftKind =
    val flies = quadrotor
    val made  = AtomicLong()
    RotorcraftKind(
      flies.stepS,
      () =>
        DisturbedRotorcraft(flies, WindAlong(wind, SplitMix64.seedOf(seed, made.getAndIncrement())), rotors)
    )

object Deviation:
  import Assignments.{number, numbers}

  val forms: String =
    "mass=FACTOR, drag=FACTOR, lag=FACTOR, rotors=A/B/C/D (shares of their thrust), wind=NORTH/EAST/DOWN " +
      "(m/s), gusts=SPEED (m/s at 20 ft), shear=ROUGHNESS (m), separated by commas"

  /** Reads, for example, `mass=1.3,drag=2,wind=8/0/0`. Left says what was expected. */
  def parse(text: String): Either[String, Deviation] = Assignments.read(text, Deviation())(one)

  private def one(of: Deviation, word: String): Either[String, Deviation] = word match
    case s"mass=$x"   => number(word, x, 0.5, 1.6).map(mass => of.copy(mass = mass))
    case s"drag=$x"   => number(word, x, 0, 10).map(drag => of.copy(drag = drag))
    case s"lag=$x"    => number(word, x, 0.3, 3).map(lag => of.copy(lag = lag))
    case s"rotors=$x" =>
      numbers(word, x, 4, 0, 1).map(rotors => of.copy(rotors = rotors))
    case s"wind=$x" =>
      numbers(word, x, 3, -MostWindMps, MostWindMps).map: wind =>
        of.copy(wind = of.wind.copy(steadyNed = Vector3(wind(0), wind(1), wind(2))))
    case s"gusts=$x" => number(word, x, 0, 30).map(gusts => of.copy(wind = of.wind.copy(gustsMps = gusts)))
    case s"shear=$x" =>
      number(word, x, 0.0001, 2).map(roughness => of.copy(wind = of.wind.copy(roughnessM = roughness)))
    case _ => Left(s"expected $forms; got '$word'")

  private val MostWindMps = 30.0
