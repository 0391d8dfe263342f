package skein.cli

import java.io.IOException
import java.nio.file.Path
import java.util.concurrent.atomic.AtomicReference
import skein.cluster.WorkerProcesses
import skein.cluster.jars.Fetched
import skein.units.Expect

/** The worker of a program that a coordinator shipped: a process of its own, which ends with this one,
  * however that ends.
  *
  * @param words of its command line
  * @param archives folder for what the JVM keeps of the program's classes
  */
private[cli] final class FetchedWorker(words: Seq[String], archives: Path):
  private enum State:
    case Waiting, Stopped
    case Running(process: Process)

  private val state = AtomicReference[State](State.Waiting)

  /** Blocks until it has ended; it tells for itself how. */
  def run(program: Fetched): Either[String, Unit] =
    try
      val process = WorkerProcesses
        .starting(WorkerProcesses.fetched(program, archives, words))
        .redirectOutput(ProcessBuilder.Redirect.INHERIT)
        .redirectError(ProcessBuilder.Redirect.INHERIT)
        .start()
      if !state.compareAndSet(State.Waiting, State.Running(process)) then process.getOutputStream.close()
      val status = process.waitFor()
      Expect.that(status == 0)(s"the coordinator's program ended with status $status")
    catch case failed: IOException => Left(s"cannot start the coordinator's program: ${failed.getMessage}")

  /** From any thread. */
  def stop(): Unit = state.getAndSet(State.Stopped) match
    case State.Running(process) => process.getOutputStream.close()
    case _                      => ()
