package skein.cli

import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.Path
import scala.concurrent.ExecutionContext.Implicits.global
import scala.concurrent.duration.*
import scala.concurrent.{Await, Future, blocking}
import skein.docs.Documentation

/** Starts programs through their launchers. */
object Launchers:
  /** The staged launcher, made by `./sbtw cli/stage`; it may not exist. */
  val staged: Path = Documentation.root.resolve("app/cli/target/universal/stage/bin/skein")

  private def prepared(command: Seq[String], javaHome: String): ProcessBuilder =
    val builder = ProcessBuilder(command*).redirectErrorStream(true)
    builder.environment.put("JAVA_HOME", javaHome): Unit
    builder

  /** Starts a launcher; its output is written to `log`. */
  def start(launcher: Path, log: Path, words: Seq[String]): Process =
    prepared(launcher.toString +: words, sys.props("java.home")).redirectOutput(log.toFile).start()

  /** Runs it to its end, within minutes.
    *
    * @return its exit status and output
    */
  def run(
      launcher: Path,
      words: Seq[String],
      javaHome: String = sys.props("java.home")
  ): (status: Int, said: String) =
    // The filter of its standard error may end after it; the pipe is read to its end.
    val piped   = Seq("bash", "-c", "set -o pipefail; \"$@\" 2>&1 | cat", "run", launcher.toString)
    val process = prepared(piped ++ words, javaHome).start()
    val said    = Future(blocking(String(process.getInputStream.readAllBytes(), UTF_8)))
    try
      val all = Await.result(said, 3.minutes)
      (process.waitFor(), all)
    finally process.destroyForcibly(): Unit
