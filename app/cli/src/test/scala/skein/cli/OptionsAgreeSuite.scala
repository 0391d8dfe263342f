package skein.cli

/** Compares the options of all commands: a word has one meaning in all of them. */
class OptionsAgreeSuite extends munit.FunSuite:
  private val options: Seq[(Command, CommandOption)] =
    for command <- Main.commands; option <- command.options yield (command, option)

  private def having(flag: String): Seq[(Command, CommandOption)] = options.filter(_._2.flag == flag)

  test("an option takes a value in every command that has it, or in none, and says what it does"):
    for (flag, same) <- options.groupBy(_._2.flag) do
      assertEquals(same.map(_._2.takesValue).distinct.size, 1, flag)
      for (command, option) <- same do
        assert(option.summary.length > 5, s"${command.name} $flag")
        assert(command.help.contains(flag), s"${command.name} $flag")

  test("--out names a folder, and no command writes results elsewhere"):
    assert(having("--out").sizeIs > 6)
    for (command, option) <- having("--out") do
      assert(option.summary.startsWith("folder "), s"${command.name}: ${option.summary}")
    assertEquals(options.map(_._2.flag).filter(Set("--output", "--folder", "--dir", "-o")), Seq.empty)

  test("the model that flies is --plant, the one that predicts is --predictor, and nothing is --model"):
    assertEquals(having("--model"), Seq.empty)
    for (command, option) <- having("--plant") do
      assert(option.summary.startsWith("model that flies"), command.name)
    for (command, option) <- having("--predictor") do
      assert(option.summary.startsWith("model that predicts"), command.name)

  test("the options for scenario, settings, seed and loops have equal descriptions in all commands"):
    for flag <- Seq("--set", "--seed") do
      val words = having(flag).map(_._2.summary.takeWhile(letter => letter != '(' && letter != ',').trim)
      assertEquals(words.distinct.size, 1, words.toString)
    for (command, option) <- having("--loop") do
      assertEquals(option.values, OptionValues.known("loop"), command.name)

  test("every command prints tables as JSON too, but for those that print none"):
    val plain =
      Set(
        "serve",
        "link",
        "link-fit",
        "export",
        "import",
        "replay",
        "digest",
        "new",
        "completion",
        "worker",
        "cluster",
        "decide"
      )
    for command <- Main.commands if !plain(command.name) do
      val json = command.options.find(_.flag == "--json")
      assert(json.exists(_.summary.contains("JSON on standard output")), command.name)
