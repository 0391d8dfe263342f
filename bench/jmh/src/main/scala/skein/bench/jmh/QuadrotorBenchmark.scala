package skein.bench.jmh

import org.openjdk.jmh.annotations.*
import skein.lanes.plant.LaneQuadrotors
import skein.units.Vector3
import skein.vehicle.{Quadrotor, Setpoint}

/** How many million steps of 3 ms does the quadrotor with its controller make a second, on one thread? With
  * SIMD, `LaneQuadrotors.VEHICLES` of them side by side, and a single one by the scalar reference.
  */
class QuadrotorBenchmark extends Rate:
  private var kernel: LaneQuadrotors = null
  private var witness                = 0.0

  @Setup
  def prepare(): Unit =
    require(LaneQuadrotors.VEHICLES == 128, s"${LaneQuadrotors.VEHICLES} vehicles")
    kernel = LaneQuadrotors.of(Quadrotor.AirSim).fold(sys.error, identity)

  @TearDown
  def show(): Unit = println(f"witness, speed after 3 s: $witness%.4f m/s")

  @Benchmark
  @OperationsPerInvocation(128 * 1000)
  def byLanes(): Double =
    for i <- 0 until LaneQuadrotors.VEHICLES do
      kernel.hover(i, Vector3(0, 0, -20))
      kernel.command(i, 10, 0, -20)
    kernel.fly(1000)
    witness = kernel.velocityNed(0).x
    witness

  @Benchmark
  @OperationsPerInvocation(1000)
  def scalar(): Double =
    val state    = Quadrotor.AirSim.hovering(Vector3(0, 0, -20))
    val setpoint = Setpoint.velocityZ(10, 0, -20)
    for _ <- 1 to 1000 do Quadrotor.AirSim.step(state, setpoint)
    witness = state.vx
    witness
