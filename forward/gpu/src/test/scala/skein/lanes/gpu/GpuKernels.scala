package skein.lanes.gpu

import java.nio.file.{Files, Path}
import skein.forward.{Pair, PlantResponse, VelocityResponse, VelocityResponses}
import skein.gpu.InterpretedGpu
import skein.lanes.*
import skein.lanes.plant.QuadrotorLanes
import skein.lanes.policy.OpponentLanes
import skein.lanes.score.{Judged, ScoreLanes}
import skein.policy.{PaperPursuer, Policy, Role}
import skein.scenario.{Reduction, Separation}
import skein.vehicle.{Quadrotor, ReducedModel}

/** Writes kernels as they go to a GPU's driver into a folder, to be read, or translated by `ptxas -v`. */
@main def gpuKernels(folder: String): Unit =
  val layout                                                        = GpuLayout(2, shows = false)
  def duels(name: String, model: VelocityResponse, pursuer: Policy) =
    val vehicle = GpuVehicle.of(model).fold(sys.error, identity)
    val duel    = Pair.paper.engagement.flownBy(Role.Pursuer, pursuer)
    val two     =
      OpponentLanes.of(duel, _ => false, inSpace = false, isPredicted = false).get.fold(sys.error, identity)
    val scores = ScoreLanes.of(Vector(Judged(Separation, Reduction.Mean, 50.1)), 2).fold(throw _, identity)
    val form   = TeamForm(two, scores, Vector(None), 60, Vector(-20, -20), Vector.empty)(byOneModel = true)
    val kernel = GpuOpponentKernel(InterpretedGpu(), duel.agents, vehicle, None, form, two, layout)
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
