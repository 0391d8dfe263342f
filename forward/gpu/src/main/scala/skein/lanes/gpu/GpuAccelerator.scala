package skein.lanes.gpu

import skein.forward.{LoopTiming, VelocityResponse}
import skein.gpu.Gpu
import skein.lanes.{AcceleratedTeams, Accelerator, Engine, Episodes}

/** An [[skein.lanes.Accelerator]] that uses a GPU. Each thread simulates one candidate in one episode. */
final class GpuAccelerator(gpu: Gpu) extends Accelerator:
  def engine: Engine =
    Engine(Engine.Kind.Gpu, s"GPU, ${gpu.name}: a thread a candidate", sideBySide = 1 << 14)

  private[lanes] def teams(
      timing: LoopTiming,
      response: VelocityResponse,
      threads: Int,
      episodes: Episodes
  ): Either[String, AcceleratedTeams] =
    for
      prediction <- GpuPrediction.of(timing)
      vehicle    <- GpuVehicle.of(response)
    yield GpuTeams(gpu, vehicle, prediction, threads, timing.periodS, episodes)
