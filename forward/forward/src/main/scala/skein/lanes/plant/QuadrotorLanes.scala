package skein.lanes.plant

import skein.formula.{Formula, Untraceable}
import skein.simd.{FixedFormula, Forms, LaneCall, LaneFunction}
import skein.units.Vector3
import skein.vehicle.{Environment, Quadrotor, QuadrotorState, Setpoint, VerticalMode}

/** Simulates quadrotors of one form with SIMD. Compiled from [[Quadrotor.stepInAir]], under `moveByVelocityZ`
  * with constant yaw, in calm air.
  */
private[lanes] final class QuadrotorLanes private (
    val quadrotor: Quadrotor,
    private[lanes] val formula: FixedFormula
):
  import QuadrotorLanes.*

  /** Names of the rows, which are the components of a vehicle's state. */
  val rows: Vector[String] = formula.inputs.map(_.stripPrefix(State)).take(formula.bound.outputs)

  def row(name: String): Int = rows.indexOf(name)

  /** The components of a state, in the order of [[rows]]. */
  def numbersOf(state: QuadrotorState): Vector[Double] = fields.map(_.getDouble(state))

  private lazy val fields = rows.map: name =>
    val field = classOf[QuadrotorState].getDeclaredField(name)
    field.setAccessible(true)
    field

  /** The position to command so that a vehicle settles at altitude `downM`, above its start. */
  def holdingAt(downM: Double): Vector3 =
    Vector3(0, 0, downM - quadrotor.hoverSagM(downM, Environment.Calm))

  /** A call that simulates one step.
    *
    * @param from rows of the states before the step
    * @param to rows of the states after it
    * @param goal rows of the command: velocity north and east, m/s, and altitude down, m
    */
  def step(from: Array[Float], to: Array[Float], goal: Array[Float]): LaneCall =
    val call = LaneCall(formula.bound, formula.parameters.map(_.toFloat))
    for (input, place) <- formula.bound.inputs.zipWithIndex do
      if input < rows.size then call.input(place, from, 0)
      else call.input(place, goal, (input - rows.size) * LaneFunction.COUNT)
    call.output(0, to, 0)
    call

private[lanes] object QuadrotorLanes:
  private val State = "state."

  /** Compiles a quadrotor. Left says why SIMD does not support it. */
  def of(quadrotor: Quadrotor): Either[String, QuadrotorLanes] =
    val airborne = Airborne(quadrotor)
    forms(airborne).map(form => QuadrotorLanes(quadrotor, form.of(airborne))).left.map(_.getMessage)

  private val forms = Forms[Airborne, FixedFormula](_.fits(_))(compiled)

  private def compiled(of: Airborne): Either[Untraceable, FixedFormula] =
    for formula <- Formula.of(of, "step", known = known)
    yield
      // The outputs of a step are the inputs of the next.
      require(formula.inputs.map(_.stripPrefix(State)).startsWith(formula.outputs.map(_._1)), formula.inputs)
      FixedFormula(formula, of, rows = formula.outputs.size)

  /** Values of those fields of a flying state that are not numbers, under `moveByVelocityZ`. */
  private def known: Map[String, Any] = Map(
    "grounded"      -> false,
    "contacts"      -> 0,
    "verticalMode"  -> VerticalMode.Position,
    "cascadeMemory" -> null
  ).map((name, value) => (State + name, value))

  /** The object whose method is compiled: one step in the air. */
  private final class Airborne(quadrotor: Quadrotor):
    def step(state: QuadrotorState, northMps: Double, eastMps: Double, downM: Double): QuadrotorState =
      quadrotor.stepInAir(state, Setpoint.velocityZ(northMps, eastMps, downM), Environment.Calm)
      state
