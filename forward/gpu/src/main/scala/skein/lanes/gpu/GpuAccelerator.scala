package skein.lanes.gpu

import skein.forward.{Delays, LoopTiming, VelocityResponse}
import skein.gpu.Gpu
import skein.lanes.{AcceleratedDuels, AcceleratedTeams, Accelerator, DuelEpisodes, Engine, TeamForm}
import skein.lanes.timetable.Timetable
import skein.units.Expect

/** A GPU as an [[skein.lanes.Accelerator]]: each thread simulates one candidate in one episode. */
final class GpuAccelerator(gpu: Gpu) extends Accelerator:
  def engine: Engine =
    Engine(Engine.Kind.Gpu, s"GPU, ${gpu.name}: a thread a candidate", sideBySide = 1 << 14)

  private[lanes] def duels(
      episodes: DuelEpisodes,
      response: VelocityResponse,
      threads: Int
  ): Either[String, AcceleratedDuels] =
    for
      _          <- Expect.that(episodes.eyes.isNobody)("the GPU flies nobody who sees by a sensor")
      prediction <- GpuPrediction.of(episodes.timing)
      vehicle    <- GpuVehicle.of(response)
    yield GpuDuels(gpu, episodes, vehicle, prediction, threads)

  private[lanes] def teams(
      timing: LoopTiming,
      response: VelocityResponse,
      threads: Int,
      timetable: (Delays, Int, TeamForm) => Timetable
  ): Either[String, AcceleratedTeams] =
    for
      prediction <- GpuPrediction.of(timing)
      vehicle    <- GpuVehicle.of(response)
    yield GpuTeams(gpu, vehicle, prediction, threads, timing.periodS, timetable)
