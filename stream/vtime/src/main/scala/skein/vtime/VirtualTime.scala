package skein.vtime

import com.typesafe.config.{Config, ConfigFactory}
import org.apache.pekko.actor.{ActorSystem, ClassicActorSystemProvider}
import org.apache.pekko.event.Logging
import org.apache.pekko.stream.SystemMaterializer
import scala.concurrent.duration.*
import scala.concurrent.{Future, Promise}
import skein.vtime.agent.{Agent, Redirect}

/** Runs actors and streams deterministically and without waiting: see the package's documentation. */
object VirtualTime:

  /** Starts an actor system in virtual time on the calling thread, runs it until the future of `body` is
    * completed, and terminates it.
    *
    * @param seed determines all of Pekko's own randomness. Equal seeds and equal bodies give equal runs, to
    *   the nanosecond.
    * @throws VirtualTimeException if something escapes virtual time, or the future can never be completed:
    *   see [[Problem]]
    * @throws Throwable if the future failed with it
    */
  def run[A](seed: Long, limits: RunLimits = RunLimits(), config: Config = ConfigFactory.load())(
      body: ActorSystem => Future[A]
  ): Finished[A] =
    if Redirect.environment() != null then
      throw IllegalStateException("VirtualTime.run was called inside of VirtualTime.run")
    val loop = Loop(seed, limits)
    loop.governing:
      requireAgent(loop)
      val system = ActorSystem("virtual", VirtualConfig(config))
      // Making it awaits an actor, so it must exist before blocking becomes an error.
      SystemMaterializer(system): Unit
      loop.booted()
      val result = Promise[A]()
      loop.post(() => result.completeWith(body(system)): Unit)
      loop.runUntil(() => result.isCompleted)(ActorTree.of(system))
      val (duration, counts) = (loop.elapsed, loop.counts)
      val terminated         = system.terminate()
      loop.runUntil(() => terminated.isCompleted)(ActorTree.of(system))
      Finished(result.future.value.get.get, duration, counts)

  /** The loop's clock, in nanoseconds since the Unix epoch; it starts at 2000-01-01T00:00:00Z.
    *
    * @throws IllegalArgumentException if `system` does not run in virtual time
    */
  def clock(system: ClassicActorSystemProvider): () => Long =
    system.classicSystem.scheduler match
      case scheduler: LoopScheduler => scheduler.loop.nanoTime
      case _ => throw IllegalArgumentException(s"${system.classicSystem} does not run in virtual time")

  /** Reads the time through rewritten code, in Pekko and in `scala.concurrent`, to check that the agent
    * works.
    */
  private def requireAgent(loop: Loop): Unit =
    def stop(detail: String)   = throw loop.fail(Problem.NoAgent(detail))
    val failure: String | Null = Agent.failure
    if failure != null then stop(s"it could not rewrite $failure")
    if Deadline.now.time.toNanos != loop.nanoTime() then stop("scala.concurrent reads the JVM's clock")
    if Logging.Info("", getClass, "").timestamp != loop.nanoTime() / 1_000_000 then
      stop("Pekko reads the JVM's clock")
