package skein.cli

import java.nio.file.Files
import skein.docs.Documentation
import skein.mujoco.MujocoLibrary
import skein.settings.PolicyFile
import skein.testing.TemporaryFolders

class DocumentedCommandsSuite extends munit.FunSuite, TemporaryFolders:

  private val files       = Seq("FILE", ".conf", ".onnx", "unix:")
  private lazy val policy =
    val text = PolicyFile.named("paper-pursuer", None)(using Main.scenarios).fold(fail(_), _.hocon(""))
    Files.writeString(temporaryFolder().resolve("policy.conf"), text).toString

  private val ofFiles = Set("--eye", "--learn", "--settings")

  /** Replaces files of earlier commands, and those found by a search of the reader's own. */
  private def withoutFiles(words: List[String]): List[String] = words match
    case option :: _ :: rest if ofFiles(option)                    => withoutFiles(rest)
    case "--policy" :: file :: rest if files.exists(file.contains) =>
      "--policy" :: policy :: withoutFiles(rest)
    case "--opponent" :: file :: rest if files.exists(file.contains) =>
      "--opponent" :: "paper-evader" :: withoutFiles(rest)
    case word :: rest =>
      word.replace("mujoco:examples", s"mujoco:${Documentation.root}/examples") :: withoutFiles(rest)
    case Nil => Nil

  test("README, guides, results and examples show commands"):
    assert(DocumentedCommands.documented.sizeIs > 80, DocumentedCommands.documented.mkString("\n"))

  for command <- DocumentedCommands.documented if !command.startsWith("--") do
    test(s"./skein $command is understood"):
      assume(!command.contains("mujoco:") || MujocoLibrary.find.isRight, "MuJoCo's library is not there")
      assume(!command.contains("recogniser=detector"), "runs with the ONNX runtime alone")
      val words = withoutFiles(DocumentedCommands.words(command).toList)
      val there = Main.commands.find(_.name == words.head).getOrElse(fail(s"no command ${words.head}"))
      assertEquals(there.checked(words.tail), Right(()))
