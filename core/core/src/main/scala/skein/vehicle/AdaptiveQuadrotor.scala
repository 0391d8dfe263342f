package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** AirSim's quadrotor as a model that learns in flight how the vehicle and the air differ from it: wind to
  * north and east, and factors on the drag, on the lag of the velocity and on the mass ([[Deviation]]).
  *
  * At each reading, an extended Kalman filter over the five parameters ([[ParameterBelief]]) is updated by
  * the errors of the predicted velocity and tilt. The effects of the parameters are found by simulating the
  * model with each of them changed a little. So a prediction costs seven times that of [[QuadrotorModel]].
  *
  * The learned model predicts only while its errors over the last [[AdaptiveQuadrotor.MemoryS]] are clearly
  * smaller than those of the nominal model, which is simulated too. Parameters stay within
  * [[AdaptiveQuadrotor.most]].
  */
object AdaptiveQuadrotor extends VehicleModel[AdaptiveQuadrotor.Learning]:

  /** Time constant of the errors that the guard compares, s. */
  val MemoryS = 2.0

  /** Longest time between two readings from which the model learns. */
  val LongestGap: Span = Span.ofSeconds(1)

  /** The learned model predicts if the nominal model's squared error is above [[Right]], m²/s², and its own
    * is below this fraction of that.
    */
  private val Better = 0.7
  private val Right  = 1e-6

  /** The parameters are the wind to north and to east, m/s, and the logarithms of the factors on drag, lag
    * and mass. For each: the standard deviation before any reading, the change within a second, the change by
    * which its effect is found, and the maximum magnitude.
    */
  private val priors = Vector(5.0, 5.0, 0.5, 0.3, 0.2)
  private val drifts = Vector(0.3, 0.3, 0.01, 0.01, 0.01)
  private val moves  = Vector(0.5, 0.5, 0.05, 0.05, 0.05)

  /** Maximum magnitude of each parameter: winds, m/s, and logarithms of factors on drag, lag and mass. */
  val most: Vector[Double] = Vector(20, 20, StrictMath.log(5), StrictMath.log(2.5), StrictMath.log(1.6))

  /** Standard deviations of the errors that even a correct model has over a tenth of a second, because of the
    * varying arrival times of commands: of velocities, m/s, and of the sines of tilts.
    */
  private val Noises = Vector(0.005, 0.005, 0.005, 0.003, 0.003)

  /** The state of a prediction, and the learned parameters.
    *
    * @param flights states by the model with the learned parameters, then by models with each parameter
    *   changed
    * @param nominalError sum of the squared velocity errors of the nominal model, m²/s², with the time
    *   constant [[MemoryS]]; `learnedError` likewise
    */
  final case class Learning private[vehicle] (
      belief: ParameterBelief,
      models: Vector[QuadrotorModel],
      nominal: QuadrotorModel.Flying,
      flights: Vector[QuadrotorModel.Flying],
      nominalError: Double,
      learnedError: Double
  ):
    /** Whether predictions use the learned parameters; otherwise they use the nominal model. */
    def helps: Boolean = nominalError > Right && learnedError < Better * nominalError

    def deviation: Deviation = deviationOf(belief.mean)

  def start(seen: Kinematics): Learning =
    val belief = ParameterBelief(priors)
    val models = modelsOf(belief)
    Learning(belief, models, QuadrotorModel.AirSim.start(seen), models.map(_.start(seen)), 0, 0)

  def advanced(learning: Learning, setpoint: Setpoint, span: Span): Learning =
    learning.copy(
      nominal = QuadrotorModel.AirSim.advanced(learning.nominal, setpoint, span),
      flights = learning.models.lazyZip(learning.flights).map(_.advanced(_, setpoint, span))
    )

  def corrected(learning: Learning, seen: Kinematics, sinceSeen: Span): Learning =
    val learned =
      if sinceSeen <= Span.Zero || sinceSeen > LongestGap then learning else learnt(learning, seen, sinceSeen)
    val base = learning.flights.head
    learned.copy(
      nominal = QuadrotorModel.AirSim.corrected(learning.nominal, seen, sinceSeen),
      // Rotors and integrators are those of the learned parameters.
      flights = learned.models.map(_.corrected(base, seen, sinceSeen))
    )

  def kinematics(learning: Learning): Kinematics =
    QuadrotorModel.AirSim.kinematics(if learning.helps then learning.flights.head else learning.nominal)

  private def learnt(learning: Learning, seen: Kinematics, sinceSeen: Span): Learning =
    val measured  = ParameterBelief.outputs(seen)
    val predicted =
      learning.flights.map(flight => ParameterBelief.outputs(QuadrotorModel.AirSim.kinematics(flight)))
    val before = learning.belief.drifted(drifts, sinceSeen.toSeconds, priors)
    val after  = before.updatedAll(measured, predicted.head, Noises): i =>
      Vector.tabulate(moves.size)(j => (predicted(j + 1)(i) - predicted.head(i)) / moves(j))
    val belief                    = after.within(most)
    val keeps                     = StrictMath.exp(-sinceSeen.toSeconds / MemoryS)
    def off(from: Vector[Double]) = measured.lazyZip(from).map(_ - _).take(3).map(x => x * x).sum
    learning.copy(
      belief = belief,
      models = modelsOf(belief),
      nominalError =
        learning.nominalError * keeps + off(
          ParameterBelief.outputs(QuadrotorModel.AirSim.kinematics(learning.nominal))
        ),
      learnedError = learning.learnedError * keeps + off(predicted.head)
    )

  private def modelsOf(belief: ParameterBelief): Vector[QuadrotorModel] =
    model(belief.mean) +: moves.indices.toVector.map: j =>
      model(belief.mean.updated(j, belief.mean(j) + moves(j)))

  private def model(parameters: Vector[Double]): QuadrotorModel =
    val deviation = deviationOf(parameters)
    QuadrotorModel(deviation.quadrotor, Environment(windNed = deviation.wind.steadyNed))

  private def deviationOf(parameters: Vector[Double]) = Deviation(
    mass = StrictMath.exp(parameters(4)),
    drag = StrictMath.exp(parameters(2)),
    lag = StrictMath.exp(parameters(3)),
    wind = Wind(Vector3(parameters(0), parameters(1), 0))
  )
