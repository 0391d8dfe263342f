package skein.cli

import java.nio.file.Path
import java.time.LocalTime
import java.time.format.DateTimeFormatter
import mainargs.{Flag, ParserForClass, arg}
import scala.concurrent.duration.DurationLong
import skein.cluster.{Tls, WorkerNode, WorkerProcesses}
import skein.scenario.Scenarios
import skein.units.{Expect, Span}

/** Command-line options of `./skein worker`, with their help texts. */
final case class WorkerOptions(
    @arg(doc = "a coordinator: a command with --cluster")
    join: String,
    @arg(doc =
      "where the coordinator reaches this worker; with --tls, HOST as " +
        "in its certificate (default: a free port of 127.0.0.1)"
    )
    listen: Option[String],
    @arg(doc = "number of threads; does not change the result (default: one per core)")
    threads: Option[Int],
    @arg(doc = "how long it tries to reach a coordinator that is absent or lost")
    patience: String = "60s",
    @arg(doc = "folder of ./skein cluster with this machine's certificate; without it, loopback alone")
    tls: Option[String],
    @arg(doc = "ends when its standard input ends, and so with the process that started it")
    attached: Flag
)

/** `./skein worker`: computes for a command on this machine or another. */
final class WorkerCommand(using Scenarios)
    extends Command[WorkerOptions](
      "worker",
      "computes for a command of this machine or another, until the command has all answers",
      ParserForClass[WorkerOptions]
    ):

  /** Time after which a stopping worker ends, even during a computation. */
  private val Grace = 3_000L

  private val LongestPatience = Span.ofSeconds(7 * 24 * 3600)

  protected def execute(options: WorkerOptions): Either[String, Unit] =
    for
      join     <- ClusterOptions.endpoint("--join", options.join)
      listen   <- options.listen.fold(Right(ClusterOptions.Loopback))(ClusterOptions.endpoint("--listen", _))
      tls      <- Expect.optional(options.tls)(folder => Tls.of(Path.of(folder)))
      threads  <- ForwardOptions.threadCount(options.threads)
      patience <- Span.parse(options.patience).left.map("--patience: " + _)
      _        <- Expect.that(patience <= LongestPatience):
        s"--patience: expected a week at most, got ${options.patience}"
      _ <- Expect.that(join.isLoopback || options.listen.isDefined):
        s"--listen: expected where the coordinator at $join reaches this worker, for example ${"HOST"}:25521"
      node = WorkerNode(join, listen, tls, threads, QuestionKind.solvers, patience.toNanos.nanos)(say)
      _    = if options.attached.value then
        WorkerProcesses.endWithParent: () =>
          node.stop()
          Thread.sleep(Grace)
          Runtime.getRuntime.halt(1)
      _ <- Edge.untilInterrupted(() => node.stop(), Grace)(node.run())
    yield ()

  private def say(line: String): Unit =
    Console.out.println(s"${LocalTime.now().format(WorkerCommand.Time)} $line")

private object WorkerCommand:
  private val Time = DateTimeFormatter.ofPattern("HH:mm:ss")
