package skein.lanes.gpu

import skein.gpu.{Gpu, GpuKernel, Ptx, Variables}
import skein.lanes.plant.QuadrotorLanes
import skein.units.Vector3
import skein.vehicle.Quadrotor

/** [[skein.lanes.plant.LaneQuadrotors]] on a GPU: each thread simulates one quadrotor with its flight
  * controller under `moveByVelocityZ`, with results that are bit-identical to those of the CPU.
  */
private[skein] final class GpuQuadrotors private (gpu: Gpu, lanes: QuadrotorLanes):
  private lazy val kernel: GpuKernel = gpu.kernel(GpuQuadrotors.text(lanes), GpuQuadrotors.Name)

  /** Simulates vehicles that hover, settled, for a number of steps under a command.
    *
    * @param goalNed position that each vehicle holds initially
    * @param commanded velocity north and east, m/s, and position down, m
    * @return final positions, world NED, m
    */
  def fly(goalNed: Array[Vector3], commanded: Array[Vector3], steps: Int): Array[Vector3] =
    import GpuQuadrotors.BlockVehicles
    val count = goalNed.length
    val known = goalNed.distinct.map(goal =>
      goal -> lanes.numbersOf(lanes.quadrotor.hovering(goal)).map(_.toFloat).toArray
    ).toMap
    val states = goalNed.map(known)
    val rows   = lanes.rows.size
    val state  = gpu.buffer(Array.tabulate(rows * count)(i => states(i % count)(i / count)))
    val after  = gpu.buffer(rows.toLong * count)
    val goal   = gpu.buffer(Array.tabulate(3 * count): i =>
      val each = commanded(i % count)
      Vector(each.x, each.y, each.z)(i / count).toFloat)
    try
      kernel((count + BlockVehicles - 1) / BlockVehicles, BlockVehicles, state, after, goal, count, steps)
      val flown                         = after.floats()
      def of(row: String)(vehicle: Int) = flown(lanes.row(row) * count + vehicle).toDouble
      Array.tabulate(count)(i => Vector3(of("x")(i), of("y")(i), of("z")(i)))
    finally
      for each <- Seq(state, after, goal) do each.close()

private[skein] object GpuQuadrotors:
  private val Name          = "quadrotors"
  private val BlockVehicles = 128

  /** Compiles the kernel. Left says why such quadrotors are not supported. */
  def of(gpu: Gpu, quadrotor: Quadrotor): Either[String, GpuQuadrotors] =
    QuadrotorLanes.of(quadrotor).map(new GpuQuadrotors(gpu, _))

  private[lanes] def text(lanes: QuadrotorLanes): String =
    val code = Ptx(
      Name,
      Seq(
        "state" -> Ptx.Kind.Address,
        "after" -> Ptx.Kind.Address,
        "goal"  -> Ptx.Kind.Address,
        "count" -> Ptx.Kind.Whole,
        "steps" -> Ptx.Kind.Whole
      )
    )
    val state   = Variables(code, lanes.rows.map(_ => 0f))
    val goal    = Variables(code, Seq.fill(3)(0f))
    val end     = code.label()
    val vehicle = code.thread()
    val count   = code.argument("count")
    code.goIf(code.compareWholes("ge", vehicle, count), end)
    def places(of: String, rows: Int) =
      Iterator.iterate(code.address(code.argument(of), vehicle))(code.address(_, count)).take(rows).toVector
    for (at, row) <- places("state", lanes.rows.size).zipWithIndex do code.load(at, 0, state(row)): Unit
    for (at, row) <- places("goal", 3).zipWithIndex do code.load(at, 0, goal(row)): Unit
    code.repeat(code.argument("steps"))(QuadrotorExpressions.step(code, lanes, state, goal))
    for (at, row) <- places("after", lanes.rows.size).zipWithIndex do code.store(state(row), at)
    code.place(end)
    code("ret")
    code.module
