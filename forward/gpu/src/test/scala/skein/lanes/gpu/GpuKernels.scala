package skein.lanes.gpu

import java.nio.file.{Files, Path}
import skein.forward.{Duel, LoopTiming, PlantResponse, VelocityResponse, VelocityResponses}
import skein.gpu.InterpretedGpu
import skein.lanes.*
import skein.lanes.plant.QuadrotorLanes
import skein.lanes.policy.PolicyLanes
import skein.policy.{PaperEvader, PaperPursuer, HeadingPolicy}
import skein.vehicle.{Quadrotor, ReducedModel}

/** Writes kernels as they go to a GPU's driver into a folder, to be read, or translated by `ptxas -v`. */
@main def gpuKernels(folder: String): Unit =
  val layout                                                               = GpuLayout(2, shows = false)
  def duels(name: String, model: VelocityResponse, pursuer: HeadingPolicy) =
    val vehicle = GpuVehicle.of(model).fold(sys.error, identity)
    val forms   = Vector(PaperEvader(), pursuer).map(PolicyLanes.get)
    val asked   = Set(PairNumber.MeanLast10s)
    val kernel  =
      GpuDuelKernel(
        InterpretedGpu(),
        Duel.paper,
        LoopTiming.Stream().periodS,
        vehicle,
        None,
        forms,
        asked,
        layout
      )
    Files.writeString(Path.of(folder, s"$name.ptx"), kernel.text): Unit
  duels("lag", PlantResponse(ReducedModel.AirSimLag), PaperPursuer())
  duels("drag", PlantResponse(ReducedModel.AirSim), PaperPursuer())
  duels("quadrotors", VelocityResponses.quadrotor(), PaperPursuer())
  duels(
    "network",
    PlantResponse(ReducedModel.AirSimLag),
    RectifiedNetwork(Array.fill(RectifiedNetwork.Weights)(0.1), 1)
  )
  val lanes = QuadrotorLanes.of(Quadrotor.AirSim).fold(sys.error, identity)
  Files.writeString(Path.of(folder, "hover.ptx"), GpuQuadrotors.text(lanes)): Unit
