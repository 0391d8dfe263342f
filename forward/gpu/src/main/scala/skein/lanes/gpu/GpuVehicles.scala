package skein.lanes.gpu

import skein.forward.{
  RolloutAgent,
  PlantResponse,
  QuadrotorResponse,
  SensedResponse,
  VelocityResponse
}
import skein.gpu.{Ptx, PtxExpressions, Variables}
import skein.lanes.plant.{PlantLanes, QuadrotorLanes}
import skein.lanes.timetable.TimetableQuadrotors
import skein.simd.BoundFunction

/** One vehicle of a team in the world of each thread. Variables contain its state. */
private[lanes] trait GpuVehicle:
  /** Sets the vehicle to rest at its start. */
  def start(): Unit

  /** Registers of position north and east, m, and, if requested, velocity, m/s. */
  def look(record: GpuRecord, withVelocity: Boolean): Vector[Int]

  /** Makes a command take effect, given as registers of its components divided by the vehicle's speed. */
  def act(record: GpuRecord, north: Int, east: Int): Unit

private[lanes] object GpuVehicle:
  /** Creates a vehicle in a kernel from the kernel's code, the agent, and the registers that hold its start:
    * north and east, m.
    */
  type Kind = (Ptx, RolloutAgent, Int, Int) => GpuVehicle

  /** The kind of vehicle for a response.
    *
    * @return Left says why the GPU does not support it
    */
  def of(response: VelocityResponse): Either[String, Kind] = response match
    case PlantResponse(plant)         => PlantLanes.of(plant).map(lanes => GpuPlant(_, _, _, _, lanes))
    case quadrotor: QuadrotorResponse =>
      QuadrotorLanes.of(quadrotor.quadrotor).map(lanes => GpuQuadrotor(_, _, _, _, lanes))
    case _: SensedResponse => Left("the GPU does not add errors to readings")
    case _                 => Left("the GPU does not know the vehicle")

/** A vehicle that moves according to a plant's [[PlantStages]]. */
private[lanes] final class GpuPlant(
    code: Ptx,
    agent: RolloutAgent,
    startX: Int,
    startY: Int,
    lanes: PlantLanes
) extends GpuVehicle:
  private val flight      = GpuStages(code, lanes, agent.speed, startX, startY)
  private val isCommanded = code.fresh()

  def start(): Unit =
    flight.start()
    code.whole(0, isCommanded): Unit

  def look(record: GpuRecord, withVelocity: Boolean): Vector[Int] =
    val (atRest, over) = (code.label(), code.label())
    val resting        = lanes.resting
    val seen           = Vector.fill(if withVelocity then 4 else 2)(code.fresh())
    code.goIf(code.compareWhole("eq", isCommanded, 0), atRest)
    flight.goOn(code.wholeOf(record.time(0)))
    for (into, value) <- seen.zip(flight.look(withVelocity, timed(record))) do code.move(value, into)
    code.go(over)
    code.place(atRest)
    val rests = Vector(
      code.two("add.rn", startX, code.constant(resting.northM.toFloat)),
      code.two("add.rn", startY, code.constant(resting.eastM.toFloat)),
      code.constant(resting.northMps.toFloat),
      code.constant(resting.eastMps.toFloat)
    )
    for (into, value) <- seen.zip(rests) do code.move(value, into)
    code.place(over)
    seen

  def act(record: GpuRecord, north: Int, east: Int): Unit =
    val (first, over) = (code.label(), code.label())
    code.goIf(code.compareWhole("eq", isCommanded, 0), first)
    flight.goOn(code.wholeOf(record.time(0)))
    flight.act(north, east, timed(record))
    code.go(over)
    code.place(first)
    flight.begin(north, east, number => code.constant(lanes.initial(number)))
    code.whole(1, isCommanded): Unit
    code.place(over)

  private def timed(record: GpuRecord)(number: Int) = record.time(1 + number)

/** A vehicle that moves according to the steps of [[QuadrotorLanes]], like [[TimetableQuadrotors]]. */
private[lanes] final class GpuQuadrotor(
    code: Ptx,
    agent: RolloutAgent,
    startX: Int,
    startY: Int,
    lanes: QuadrotorLanes
) extends GpuVehicle:
  private val hovering = lanes.numbersOf(lanes.quadrotor.hovering(lanes.holdingAt(agent.altitudeDownM)))
  private val state    = Variables(code, hovering.map(_.toFloat))
  private val goal     = Variables(code, Seq(0f, 0f, lanes.holdingAt(agent.altitudeDownM).z.toFloat))

  def start(): Unit =
    state.start()
    goal.start()

  def look(record: GpuRecord, withVelocity: Boolean): Vector[Int] =
    fly(record)
    val since                 = record.time(1)
    val half                  = code.two("mul.rn", code.two("mul.rn", since, since), code.constant(0.5f))
    def numbers(row: String*) = row.map(name => state(lanes.row(name))).toVector
    def carried(of: BoundFunction, by: Vector[Int]) =
      PtxExpressions.write(code, of.nodes)(input => by(of.inputs(input)), Vector(since, half))
    val starts   = Vector(startX, startY)
    val position = Vector("x", "y").zip(starts).map((axis, start) =>
      carried(TimetableQuadrotors.placed, numbers(s"a$axis", s"v$axis", axis) :+ start).head
    )
    val velocity =
      if withVelocity then
        Vector("x", "y").map(axis => carried(TimetableQuadrotors.moved, numbers(s"a$axis", s"v$axis")).head)
      else Vector.empty
    position ++ velocity

  def act(record: GpuRecord, north: Int, east: Int): Unit =
    fly(record)
    val speed = code.constant(agent.speed.toFloat)
    goal.take(Seq(
      code.two("mul.rn", north, speed),
      code.two("mul.rn", east, speed),
      code.constant(agent.altitudeDownM.toFloat)
    ))

  private def fly(record: GpuRecord): Unit =
    code.repeat(code.wholeOf(record.time(0)))(QuadrotorExpressions.step(code, lanes, state, goal))
