package skein.cli

import java.nio.file.{Files, Path}
import skein.testing.{TemporaryFolders, Unhurried}

/** The JVM options of our launcher and of a user project's: a fake JVM prints them. */
class LauncherVectorsLiveSuite extends munit.FunSuite, Unhurried, TemporaryFolders:
  private lazy val scratch = temporaryFolder()

  private lazy val echoing: Path =
    val home = Files.createDirectories(scratch.resolve("jdk/bin")).getParent
    Files.writeString(home.resolve("release"), "JAVA_VERSION=\"25\"\n")
    for program <- Seq("java", "javac") do
      val file = home.resolve("bin").resolve(program)
      Files.writeString(
        file,
        """#!/usr/bin/env bash
          |if [ "$1" = -version ]; then echo 'openjdk version "25"'; exit; fi
          |echo 'WARNING: Using incubator modules: jdk.incubator.vector' >&2
          |echo 'a word to standard error' >&2
          |echo "started with $*"
          |""".stripMargin
      )
      file.toFile.setExecutable(true): Unit
    home

  /** A user project whose build does nothing. */
  private lazy val project: Path =
    val folder = scratch.resolve("patrol")
    assertEquals(Ran.of(NewCommand.run(Seq("patrol", "--out", folder.toString))).status, 0)
    Files.createDirectories(folder.resolve("target"))
    Files.writeString(folder.resolve("target/launch"), "\"patrol.Main\"\n")
    folder.resolve("skein")

  private val commands = Main.commands.map(_.name)

  for (name, launcher) <- Seq("Skein's" -> (() => Launchers.staged), "a project's" -> (() => project)) do
    test(s"$name launcher enables the JDK's vector module for every command, silently"):
      assume(Files.exists(launcher()), "./sbtw cli/stage makes the launcher")
      for command <- commands do
        val (status, said) = Launchers.run(launcher(), Seq(command, "--loop", "stream"), echoing.toString)
        assertEquals(status, 0, said)
        assert(said.contains("--add-modules=jdk.incubator.vector"), s"$command: $said")
        assert(said.contains("a word to standard error"), s"$command: $said")
        assert(!said.contains("WARNING"), s"$command: $said")
