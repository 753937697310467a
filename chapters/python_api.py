# ---
# jupyter:
#   jupytext:
#     formats: py:percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # The library from Python
#
# The functions and classes for your own rod, worm or robot, with the signatures and docstrings of the library itself. The
# keys of parameter classes are on the page [Keys of a case](case_keys.ipynb); in Python their values may also be
# plain numbers in SI units. The first names are those of `cosserat` itself.
#
# ## Cases and results
#
# ```{eval-rst}
# .. autofunction:: cosserat.run
#
# .. autoclass:: cosserat.Limits
#    :members:
#
# .. autofunction:: cosserat.modes
#
# .. autofunction:: cosserat.case
#
# .. autofunction:: cosserat.published
#
# .. autofunction:: cosserat.load_cases
#
# .. autoclass:: cosserat.Case
#    :members:
#
# .. autofunction:: cosserat.save
#
# .. autofunction:: cosserat.load
#
# .. autofunction:: cosserat.case_of
#
# .. autofunction:: cosserat.to_dataframe
#
# .. autofunction:: cosserat.data.dataset.statistics_of
#
# .. autofunction:: cosserat.plot
#
# .. autofunction:: cosserat.animate
# ```
#
# ## Studies
#
# ```{eval-rst}
# .. autofunction:: cosserat.study
#
# .. autofunction:: cosserat.studies.door.case_of_study
#
# .. autofunction:: cosserat.indices
#
# .. autofunction:: cosserat.bands
#
# .. autofunction:: cosserat.orders
#
# .. autofunction:: cosserat.estimate_error
#
# .. autofunction:: cosserat.sensitivity
#
# .. autofunction:: cosserat.fit
#
# .. autofunction:: cosserat.design
# ```
#
# ## Players
#
# `cosserat.animate` gives a stage, which a notebook shows as a player. A stage of your own needs no result:
#
# ```{eval-rst}
# .. autoclass:: cosserat.figures.stage.Stage
#
# .. autoclass:: cosserat.figures.stage.Panel
#
# .. autoclass:: cosserat.figures.stage.Line
#
# .. autoclass:: cosserat.figures.stage.Mark
#
# .. autoclass:: cosserat.figures.stage.Slider
#
# .. autofunction:: cosserat.figures.player.figure
#
# .. autofunction:: cosserat.figures.player.page
# ```
#
# ## Errors
#
# ```{eval-rst}
# .. autoexception:: cosserat.CosseratError
#
# .. autoexception:: cosserat.InputError
#
# .. autoexception:: cosserat.errors.OverLimitError
#
# .. autoexception:: cosserat.errors.ChangedResultWarning
#
# .. autoexception:: cosserat.UnsupportedRodError
#
# .. autoexception:: cosserat.NotConvergedError
#
# .. autoexception:: cosserat.errors.CrossingError
#
# .. autoexception:: cosserat.errors.UnstableError
#
# .. autoexception:: cosserat.errors.DivergedError
#
# .. autoexception:: cosserat.errors.OutOfReachError
# ```
#
# ## Problems
#
# Each kind of problem is a class.
#
# ```{eval-rst}
# .. autoclass:: cosserat.problem.Problem
#    :members:
#
# .. autoclass:: cosserat.problem.Run
#    :members:
#
# .. autoclass:: cosserat.solution.Solution
#    :members:
#
# .. autoclass:: cosserat.rods.problem.RodProblem
#    :members:
#
# .. autoclass:: cosserat.problems.static.RodStatics
#    :members:
#
# .. autoclass:: cosserat.problems.motion.RodMotion
#    :members:
#
# .. autoclass:: cosserat.problems.starts.Start
#    :members:
#
# .. autoclass:: cosserat.problems.damping.Damping
#    :members:
#
# .. autoclass:: cosserat.problems.damping.Vibrations
#    :members:
#
# .. autoclass:: cosserat.problems.path.RodPath
#    :members:
#
# .. autoclass:: cosserat.problems.modes.RodModes
#    :members:
#
# .. autoclass:: cosserat.problems.critical.RodCriticalLoads
#    :members:
#
# .. autoclass:: cosserat.problems.crawl.Posture
#    :members:
#
# .. autoclass:: cosserat.problems.crawl.Crawl
#    :members:
# ```
#
# ## Rods and crawlers
#
# ```{eval-rst}
# .. autoclass:: cosserat.rods.rod.Rod
#    :members:
#
# .. autoclass:: cosserat.rods.sections.section.Section
#    :members:
#
# .. autoclass:: cosserat.rods.sections.section.Homogeneous
#    :members:
#
# .. autoclass:: cosserat.rods.material.Material
#    :members:
#
# .. autoclass:: cosserat.rods.variation.Station
#    :members:
#
# .. autofunction:: cosserat.rods.variation.lump
#
# .. autoclass:: cosserat.rods.kinematics.Kinematics
#    :members:
#
# .. autoclass:: cosserat.rods.energies.energy.Energy
#    :members:
#
# .. autoclass:: cosserat.rods.loads.load.Load
#    :members:
#
# .. autoclass:: cosserat.rods.loads.base.BaseMotion
#    :members:
#
# .. autoclass:: cosserat.rods.constraints.Constraint
#    :members:
#
# .. autoclass:: cosserat.rods.supports.Support
#    :members:
#
# .. autoclass:: cosserat.rods.attachments.attachment.Attachment
#    :members:
#
# .. autoclass:: cosserat.rods.masses.Mass
#    :members:
#
# .. autoclass:: cosserat.rods.probes.Probe
#    :members:
#
# .. autofunction:: cosserat.rods.resultants.resultants
#
# .. autoclass:: cosserat.rods.resultants.Resultants
#    :members:
#
# .. autofunction:: cosserat.rods.stresses.beam_stresses
#
# .. autoclass:: cosserat.rods.stresses.Stresses
#    :members:
#
# .. autoclass:: cosserat.rods.reference.Geometry
#    :members:
#
# .. autofunction:: cosserat.rods.reference.strains
#
# .. autoclass:: cosserat.rods.reference.Strains
#    :members:
#
# .. autoclass:: cosserat.peristalsis.crawler.Crawler
#    :members:
#
# .. autoclass:: cosserat.peristalsis.body.BodySegment
#
# .. autoclass:: cosserat.peristalsis.gait.Gait
#    :members:
#
# .. autoclass:: cosserat.peristalsis.chambers.Chamber
#
# .. autoclass:: cosserat.peristalsis.measured.Measured
# ```
#
# ## The continuous rod
#
# The directed rod of Chapter 1, one section at a time, and the bodies of its twelve deformations.
#
# ```{eval-rst}
# .. autoclass:: cosserat.rods.directed_rod.Section
#    :members:
#
# .. autoclass:: cosserat.rods.directed_rod.Offset
#
# .. autofunction:: cosserat.rods.directed_rod.lame
#
# .. autodata:: cosserat.figures.deformations.DEFORMATIONS
#    :no-value:
#
# .. autofunction:: cosserat.rods.directed_rod.measures
#
# .. autofunction:: cosserat.rods.directed_rod.stretches
#
# .. autofunction:: cosserat.rods.directed_rod.integrated_stiffnesses
#
# .. autofunction:: cosserat.rods.directed_rod.adjusted_stiffnesses
#
# .. autofunction:: cosserat.rods.directed_rod.strain_energy
#
# .. autofunction:: cosserat.rods.directed_rod.energy_gradient
#
# .. autofunction:: cosserat.rods.directed_rod.offset_energy
#
# .. autofunction:: cosserat.rods.directed_rod.forces
#
# .. autofunction:: cosserat.rods.directed_rod.internal_forces
#
# .. autofunction:: cosserat.rods.directed_rod.couple
#
# .. autofunction:: cosserat.rods.directed_rod.unbalanced_couple
#
# .. autoclass:: cosserat.rods.directed_rod.Inertia
#    :members:
#
# .. autofunction:: cosserat.rods.constrained_rod.constrained_forces
#
# .. autofunction:: cosserat.rods.constrained_rod.uniform_state
#
# .. autoclass:: cosserat.figures.deformations.Deformation
#    :members:
# ```
#
# ## Solvers
#
# They are independent of rods: a body and its loads give their energy, gradient and Hessian, and one object, the system,
# is the input of statics, paths, motion and modes.
#
# ```{eval-rst}
# .. autoclass:: cosserat.solvers.potential.Potential
#    :members:
#
# .. autodata:: cosserat.solvers.potential.KERNEL
#    :no-value:
#
# .. autoclass:: cosserat.solvers.system.MechanicalSystem
#    :members:
#
# .. autoclass:: cosserat.solvers.system.Constraints
#    :members:
#
# .. autoclass:: cosserat.solvers.system.ConfigurationSpace
#    :members:
#
# .. autoclass:: cosserat.solvers.equilibrium.Equilibrium
#    :members:
#
# .. autoclass:: cosserat.solvers.equilibrium.EquilibriumSolver
#    :members:
#
# .. autofunction:: cosserat.solvers.incremental.solve_full_load
#
# .. autofunction:: cosserat.solvers.continuation.trace_path
#
# .. autoclass:: cosserat.solvers.continuation.ArcLengthSettings
#    :members:
#
# .. autoclass:: cosserat.solvers.integrate.State
#    :members:
#
# .. autofunction:: cosserat.solvers.integrate.integrate
#
# .. autofunction:: cosserat.solvers.special.special_points
#
# .. autoclass:: cosserat.solvers.special.SpecialPoint
#    :members:
#
# .. autofunction:: cosserat.solvers.critical.linear_criterion
#
# .. autoclass:: cosserat.solvers.critical.LinearCriterion
#    :members:
#
# .. autofunction:: cosserat.solvers.critical.first_special_point
#
# .. autofunction:: cosserat.solvers.modes.small_motions
#
# .. autoclass:: cosserat.solvers.modes.SmallMotions
#    :members:
#
# .. autofunction:: cosserat.solvers.modes.modes
#
# .. autoclass:: cosserat.solvers.modes.Modes
#    :members:
# ```
#
# ## Closed forms
#
# Exact and classical answers to compare with: beams in small displacements, and the elastica.
#
# ```{eval-rst}
# .. autoclass:: cosserat.exact.beams.Beam
#    :members:
#
# .. autofunction:: cosserat.problems.calibration.beam_of
#
# .. autofunction:: cosserat.exact.beams.hanging_bar_displacement
#
# .. autofunction:: cosserat.exact.beams.clamped_free_displacement
#
# .. autofunction:: cosserat.exact.beams.clamped_free_director
#
# .. autofunction:: cosserat.exact.beams.clamped_clamped_displacement
#
# .. autofunction:: cosserat.exact.beams.clamped_clamped_director
#
# .. autofunction:: cosserat.exact.beams.first_beam_mode
#
# .. autofunction:: cosserat.exact.beams.first_frequency
#
# .. autofunction:: cosserat.exact.beams.necking_decay
#
# .. autofunction:: cosserat.exact.beams.necking_strain
#
# .. autofunction:: cosserat.exact.beams.clamped_free_tip_of_published_rod
#
# .. autofunction:: cosserat.exact.elastica.shearable_tip
#
# .. autofunction:: cosserat.exact.elastica.column_tip
#
# .. autofunction:: cosserat.exact.elastica.column_load
#
# .. autofunction:: cosserat.exact.elastica.timoshenko_frequencies
# ```
