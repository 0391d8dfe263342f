package skein.cli

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.Using
import skein.docs.Documentation
import skein.testing.{TemporaryFolders, Unhurried}

/** The script `./skein`, in a checkout with a fake build, so that each start takes a moment. */
class LauncherLiveSuite extends munit.FunSuite, Unhurried, TemporaryFolders:
  /** The path at which a build puts the program. */
  private val program = "app/cli/target/package/skein-1.0-any"

  private val copy = FunFixture[Path](
    _ =>
      val folder = temporaryFolder().toRealPath()
      Files.createDirectories(folder.resolve("project"))
      for name <- Seq("skein", "project/find-jdk") do
        Files.copy(Documentation.root.resolve(name), folder.resolve(name))
        folder.resolve(name).toFile.setExecutable(true): Unit
      script(
        folder.resolve("sbtw"),
        s"""echo "sbt $$*"
           |mkdir -p $program/bin
           |printf '#!/usr/bin/env bash\necho "flown from $$0: $$*"\n' >$program/bin/skein
           |chmod +x $program/bin/skein""".stripMargin
      )
      Files.writeString(folder.resolve("build.sbt"), "")
      folder
    ,
    folder =>
      run(folder.getParent, Map.empty, "chmod", "-R", "u+w", folder.toString): Unit
      Using.resource(
        Files.walk(folder)
      )(_.sorted(java.util.Comparator.reverseOrder()).forEach(Files.delete(_)))
  )

  private def script(file: Path, body: String): Unit =
    Files.writeString(file, s"#!/usr/bin/env bash\n$body\n")
    file.toFile.setExecutable(true): Unit

  /** Exit status, and both outputs combined. */
  private def run(in: Path, environment: Map[String, String], command: String*): (Int, String) =
    val builder = ProcessBuilder(command*).directory(in.toFile).redirectErrorStream(true)
    builder.environment.keySet.asScala.toSeq
      .filter(name => environment.get(name).contains(""))
      .foreach(builder.environment.remove(_))
    environment.filter(_._2.nonEmpty).foreach((name, value) => builder.environment.put(name, value))
    builder.environment.put("JAVA_HOME", sys.props("java.home"))
    val process = builder.start()
    val said    = String(process.getInputStream.readAllBytes())
    (process.waitFor(), said)

  copy.test("the launcher starts through chains of symbolic links, also relative ones"): folder =>
    val links = Files.createDirectories(folder.resolve("links"))
    Files.createSymbolicLink(links.resolve("one"), Path.of("../skein"))
    Files.createSymbolicLink(links.resolve("two"), links.resolve("one"))
    val (status, said) = run(links, Map.empty, "./two", "fly", "--seed 1")
    assertEquals(status, 0, said)
    assert(clue(said).contains(s"$folder/$program/bin/skein: fly --seed 1"))

  copy.test("the launcher builds an incomplete program again, and not a complete one"): folder =>
    script(
      folder.resolve("sbtw"),
      s"""mkdir -p $program/bin $program/lib $program/runtime/bin
         |printf '#!/usr/bin/env bash\necho flown\n' >$program/bin/skein
         |chmod +x $program/bin/skein
         |touch $program/lib/one.jar $program/lib/other.jar $program/lib/skein.aot $program/runtime/bin/java""".stripMargin
    )
    def started() =
      val (status, said) = run(folder, Map.empty, "./skein", "fly")
      assert(status == 0 && said.contains("flown"), said)
      said.contains("building")
    assert(started())
    assert(!started())
    for taken <- Seq("bin/skein", "lib/other.jar", "lib/skein.aot", "runtime/bin/java") do
      Files.delete(folder.resolve(program).resolve(taken))
      assert(started(), taken)
      assert(!started(), taken)

  copy.test("the program is built with its runtime and cache, and built again for a new version"): folder =>
    assertEquals(run(folder, Map.empty, "./skein", "fly")._1, 0)
    assertEquals(Files.readString(folder.resolve("target/build.log")), "sbt cli/program\n")
    script(
      folder.resolve("sbtw"),
      s"""rm -r $program
         |mkdir -p ${program}er/bin
         |printf '#!/usr/bin/env bash\necho newer\n' >${program}er/bin/skein
         |chmod +x ${program}er/bin/skein""".stripMargin
    )
    Files.delete(folder.resolve(program).resolve("bin/skein"))
    assert(clue(run(folder, Map.empty, "./skein", "fly")._2).endsWith("newer\n"))
    assertEquals(run(folder, Map.empty, "./skein", "fly"), (0, "newer\n"))

  copy.test("the launcher starts without HOME"): folder =>
    val (status, said) = run(folder, Map("HOME" -> ""), "./skein", "--help")
    assertEquals(status, 0, said)

  copy.test("a checkout that cannot be written to is built in the cache, once"): folder =>
    val cache = Files.createDirectories(folder.resolve("cache"))
    run(folder, Map.empty, "chmod", "a-w", folder.toString): Unit
    assume(!Files.isWritable(folder), "whoever may write everywhere has no such checkout")
    val (status, said) = run(cache, Map("XDG_CACHE_HOME" -> cache.toString), s"$folder/skein", "fly")
    assertEquals(status, 0, said)
    assert(clue(said).contains(s"cannot be written to"))
    assert(said.contains(s"flown from $cache"))
    val (_, again) = run(cache, Map("XDG_CACHE_HOME" -> cache.toString), s"$folder/skein", "fly")
    assert(!clue(again).contains("building"))

  test("a truncated class archive is removed, and a complete one is used"):
    val folder = temporaryFolder()
    Files.createDirectories(folder.resolve("bin"))
    Files.copy(Documentation.root.resolve("project/class-archive"), folder.resolve("class-archive"))
    script(
      folder.resolve("launcher"),
      """addJava() { echo "$1"; }
        |app_home=bin
        |. ./class-archive""".stripMargin
    )
    for (words, name) <- Seq((Seq("worker", "--join"), "skein-worker.jsa"), (Seq("fly"), "skein.jsa")) do
      val archive                        = folder.resolve(name)
      def isKeptWith(bytes: Array[Byte]) =
        Files.write(archive, bytes)
        val (status, said) = run(folder, Map.empty, "./launcher" +: words*)
        assertEquals(status, 0, said)
        assert(clue(said).contains(s"-XX:SharedArchiveFile=bin/../$name\n"))
        Files.exists(archive)
      assert(isKeptWith(Array[Byte](0xa8.toByte, 0x0b, 0xf0.toByte, 0x0f)))
      assert(!isKeptWith(Array[Byte](0, 0, 0, 0, 1)))
      assert(!isKeptWith(Array.emptyByteArray))

  test("an old Java, and a missing one, are reported in one line"):
    val folder = temporaryFolder()
    Files.copy(Documentation.root.resolve("project/java-version"), folder.resolve("java-version"))
    script(
      folder.resolve("launcher"),
      """. ./java-version
        |java_cmd=$1
        |java_version_check
        |echo started""".stripMargin
    )
    def started(version: String) =
      script(
        folder.resolve("java"),
        s"echo 'Picked up JAVA_TOOL_OPTIONS: -Dversion=1' >&2; echo '$version' >&2"
      )
      run(folder, Map.empty, "./launcher", "./java")
    for (version, major) <- Seq("1.8.0_402" -> 8, "17.0.15" -> 17, "24-ea" -> 24) do
      assertEquals(
        started(s"""openjdk version "$version" 2025-04-15"""),
        (1, s"skein: Skein needs Java 25, this is $major (./java); set JAVA_HOME\n")
      )
    for version <- Seq("25", "25.0.3", "26-ea") do
      assertEquals(started(s"""openjdk version "$version" 2026-04-21"""), (0, "started\n"))
    assertEquals(
      run(folder, Map.empty, "./launcher", "./none"),
      (1, "skein: Skein needs Java 25, and there is none as ./none; set JAVA_HOME\n")
    )

    // The `release` file of a JVM is trusted, without starting the JVM.
    Files.createDirectories(folder.resolve("jdk/bin"))
    script(folder.resolve("jdk/bin/java"), "echo started for its version; exit 1")
    for (version, expected) <- Seq(
        "25.0.3"  -> (0, "started\n"),
        "17.0.15" -> (1, "skein: Skein needs Java 25, this is 17 (jdk/bin/java); set JAVA_HOME\n")
      )
    do
      Files.writeString(folder.resolve("jdk/release"), s"IMPLEMENTOR=\"Any\"\nJAVA_VERSION=\"$version\"\n")
      assertEquals(run(folder, Map.empty, "./launcher", "jdk/bin/java"), expected)

  test("the last output on standard error is kept when a whole process group is ended"):
    val folder = temporaryFolder()
    Files.copy(Documentation.root.resolve("project/quiet-vectors"), folder.resolve("quiet-vectors"))
    script(
      folder.resolve("launcher"),
      """. ./quiet-vectors
        |trap 'echo last >&2; exit 3' TERM
        |echo first >&2
        |until grep -q first said; do sleep 0.01; done
        |kill -TERM 0""".stripMargin
    )
    // With job control a job has a process group of its own.
    val (_, said) = run(
      folder,
      Map.empty,
      "bash",
      "-c",
      """set -m
        |./launcher 2>said &
        |wait $!
        |for _ in $(seq 200); do grep -q last said && break; sleep 0.01; done
        |cat said""".stripMargin
    )
    // Follows bash's message on a job that ended.
    assert(clue(said).endsWith("first\nlast\n"))
