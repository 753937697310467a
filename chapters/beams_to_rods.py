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
# # From beams to directed rods
#
# A beam theory follows a line and, at each point of this line, a flat section that keeps its shape. This is enough for a
# steel girder. It is not enough for a rubber band, which becomes thin when it is pulled, or for a worm, which crawls by
# becoming thin and fat. A directed rod follows the same line, but its sections may also stretch and shear. This page starts
# with beams as they are taught, lets the section deform, and ends with the twelve ways in which it can do so.
#
# :::{admonition} After this chapter you can
# :class: objectives
#
# * say what a director is, and what the nine numbers mean that describe a section;
# * write the balances of forces and of director forces for a slice of a rod;
# * find the beams of Timoshenko and of Euler and Bernoulli as special directed rods;
# * name the twelve deformations of a section, and the stiffness that pays for each.
# :::
#
# ## What a beam knows about its sections
#
# Every theory in this table describes a slender body by some functions of one variable, the distance along the body. The
# theories differ in what they let a section do.
#
# | theory | what a section may do | functions in space |
# |---|---|---|
# | bar | move along the axis | 1 |
# | Euler and Bernoulli's beam | move, and turn with the axis; twist about it | 4 |
# | Timoshenko's beam | move, and turn by itself | 6 |
# | directed rod | move, turn, stretch in two directions, and shear | 9 |
#
# ## Directors
#
# Three fixed unit vectors $\mathbf{E}_1, \mathbf{E}_2, \mathbf{E}_3$ are at right angles. The unloaded rod is straight and
# lies along $\mathbf{E}_3$. Its points on the axis are told apart by their distance $\xi$ from one end, and its sections
# have coordinates $X^1, X^2$ along $\mathbf{E}_1$ and $\mathbf{E}_2$. Draw two arrows of unit length into each section:
# $\mathbf{D}_1 = \mathbf{E}_1$ and $\mathbf{D}_2 = \mathbf{E}_2$. These are the *reference directors*.

# %% tags=["remove-cell"]
import itertools

import numpy as np

import cosserat
from cosserat.figures.deformations import DEFORMATIONS
from cosserat.rods import directed_rod
from cosserat.thesis.book import page

# %% tags=["remove-input"]
page.figure(
    "fig_directors",
    "A bar at rest, and the same bar when it is bent, twisted and thinned. The lines on its surface move with the material. In "
    "its neck the directors $\\mathbf{d}_1$ and $\\mathbf{d}_2$ are short and $\\mathbf{d}_3$ is long. Each of the three has "
    "a scale of its own.",
)

# %% [markdown]
# Now load the rod. The point $\xi$ of the axis moves to $\mathbf{r}(\xi)$. The two arrows move with the material: they
# become $\mathbf{d}_1(\xi)$ and $\mathbf{d}_2(\xi)$, the *directors*. They may be longer or shorter than before, and the angle
# between them may change. The theory assumes that the whole section deforms as its two arrows do. Then the place of
# every material point is known:
#
# $$
# \mathbf{r}^* = \mathbf{r} + X^1 \mathbf{d}_1 + X^2 \mathbf{d}_2 .
# $$
#
# This is equation (1.3.4) of the thesis. It writes the sum as $X^\beta \mathbf{d}_\beta$: *an index that appears twice is
# summed*. Greek indices $\alpha, \beta$ are 1 or 2, Latin indices $i, j$ are 1, 2 or 3. A prime is a derivative by
# $\xi$. The third director is the derivative of the centreline, $\mathbf{d}_3 = \mathbf{r}'$; its length is the stretch of
# the axis.
#
# So a section has nine numbers: three of $\mathbf{r}$, three of $\mathbf{d}_1$ and three of $\mathbf{d}_2$. If the section is
# rigid, both directors keep their unit length and their right angle. These are three conditions, and six numbers are left:
# Timoshenko's.

# %% [markdown]
# ## Strains are what a rotation does not change
#
# A rod that only moves and rotates stores no energy. So the energy may depend only on quantities that a rotation leaves as
# they are. Scalar products have this property. The thesis takes their changes from the straight rod,
#
# $$
# \gamma_{ij} = \mathbf{d}_i \cdot \mathbf{d}_j - \mathbf{D}_i \cdot \mathbf{D}_j , \qquad
# \kappa_{\alpha i} = \mathbf{d}'_\alpha \cdot \mathbf{d}_i - \mathbf{D}'_\alpha \cdot \mathbf{D}_i ,
# $$
#
# as its measures of strain (1.2.19). The $\gamma_{ij}$ compare the directors of one section with each other: their lengths and
# their angles. They have no unit. The $\kappa_{\alpha i}$ say how the directors change from one section to the next. Their unit
# is 1/m. There are six different $\gamma_{ij}$, since $\gamma_{ij} = \gamma_{ji}$, and six $\kappa_{\alpha i}$.
#
# The library computes them from the directors. Here a section is rotated by 0.7 rad, and then it is also made
# wider by five per cent along $\mathbf{d}_2$:

# %%
turn = np.array([[np.cos(0.7), np.sin(0.7), 0], [-np.sin(0.7), np.cos(0.7), 0], [0, 0, 1]])
wider = np.diag([1.0, 1.05, 1.0])
gamma_rotated, _ = directed_rod.measures(turn, np.zeros((2, 3)))
gamma_wider, _ = directed_rod.measures(wider @ turn, np.zeros((2, 3)))
print(f"rotated: the largest strain is {abs(gamma_rotated).max():.0e}")
print(f"rotated and wider: gamma_22 is {gamma_wider[1, 1]:.4f}")

# %% tags=["remove-cell"]
assert abs(gamma_rotated).max() < 1e-15
assert abs(gamma_wider[1, 1] - (1.05**2 - 1)) < 1e-15

# %% [markdown]
# A fibre that grows by the share $\varepsilon$ of its length has $\gamma = (1 + \varepsilon)^2 - 1$, which is about $2 \varepsilon$. So
# $\gamma_{11}, \gamma_{22}, \gamma_{33}$ are about *twice* the strain of an engineer. The factors $\tfrac14$ in the stiffnesses of Chapter 1 come from this.
#
# ## What acts on a slice
#
# Cut a slice of the length $\mathrm{d}\xi$ out of the rod. Its neighbours pull on its two faces, and the rest of the world
# acts on it from outside. The figure shows these loads three times.

# %% tags=["remove-input"]
page.figure(
    "fig_slice",
    "The loads on a slice. (a) The contact force $\\mathbf{n}$ on both faces, and the assigned force $\\rho_0 \\mathbf{f}$ per "
    "length. (b) Loads that push the upper and the lower half apart or together. (c) Loads that pull one half along the "
    "rod and push the other: the couple of a beam.",
)

# %% [markdown]
# **Forces.** The contact force $\mathbf{n}(\xi)$ is the sum of the stresses on a section, in N. The part of the rod beyond the
# section exerts $\mathbf{n}$ on the part before it, and receives $-\mathbf{n}$. The mass per length is
# $\rho_0$, in kg/m, and $\mathbf{f}$ is the assigned force per mass, such as gravity. A slice at rest is in
# balance:
#
# $$
# \mathbf{n}(\xi + \mathrm{d}\xi) - \mathbf{n}(\xi) + \rho_0 \mathbf{f}\, \mathrm{d}\xi = \mathbf{0}
# \quad \Rightarrow \quad \mathbf{n}' + \rho_0 \mathbf{f} = \mathbf{0} . \tag{1.2.71}
# $$
#
# This is the same as in a beam. In a motion the rate of the linear momentum stands on the right-hand side.
#
# **Director forces.** A force says nothing about the shape of the section: two equal and opposite stresses, one at the top
# and one at the bottom, cancel in $\mathbf{n}$. So multiply the stress by the coordinate $X^\alpha$ before you add it up. The
# result is the *contact director force* $\mathbf{m}^\alpha$, in N m. In picture (b) it has the direction of $\mathbf{d}_1$ and
# pulls the upper half of the section up and the lower half down. The same is done with the loads from outside: a pressure on
# the lateral surface gives the *assigned director force* $\rho_0 \mathbf{l}^\alpha$ per length, in N.
#
# One more load has no counterpart in a beam. Cut the slice into its upper and lower half. The stress on this cut holds the
# halves together. Its sum over the section is the *intrinsic director force* $\mathbf{k}^\alpha$ per length, in
# N: the resistance of the section itself. It acts against the other loads, hence the minus:
#
# $$
# \mathbf{m}^{\alpha\prime} - \mathbf{k}^\alpha + \rho_0 \mathbf{l}^\alpha = \mathbf{0} . \tag{1.2.82}
# $$
#
# These are two vector equations, one for each director. They say how fat and how sheared a section is. If you press a rubber
# cylinder from its side, $\rho_0 \mathbf{l}^1$ is what you do, $\mathbf{k}^1$ is what the rubber answers, and
# $\mathbf{m}^1$ is the help of the sections next to it.
#
# **Moments.** Picture (c) is the same $\mathbf{m}^1$, now along $\mathbf{d}_3$. It is tension above and compression below, so it
# bends. The moment of a beam is made of the director forces,
#
# $$
# \mathbf{m} = \mathbf{d}_\beta \times \mathbf{m}^\beta , \tag{1.2.89}
# $$
#
# and the balance of moments of a beam need not be postulated. Differentiate (1.2.89), insert (1.2.82), and use that the
# stress of the material is symmetric, which for a rod is equation (1.2.91) of Chapter 1:
#
# $$
# \mathbf{m}' = \mathbf{d}'_\beta \times \mathbf{m}^\beta + \mathbf{d}_\beta \times \mathbf{k}^\beta
# - \mathbf{d}_\beta \times \rho_0 \mathbf{l}^\beta
# \quad \Rightarrow \quad \mathbf{m}' + \mathbf{r}' \times \mathbf{n} + \mathbf{d}_\beta \times \rho_0 \mathbf{l}^\beta
# = \mathbf{0} .
# $$
#
# The cell below tries this step on an arbitrary state. It takes directors that are polynomials of $\xi$, computes the forces
# with the energy of the library, finds the $\rho_0 \mathbf{l}^\alpha$ that keeps the directors in balance, and looks at what is
# left of the moments. The derivatives are exact to the last digits, because they use a complex step: the derivative
# of $f$ is the imaginary part of $f(\xi + \mathrm{i}h)/h$ for a very small $h$, and nothing is subtracted.

# %% tags=["hide-cell"]
rng = np.random.default_rng(7)
round_section = directed_rod.Section.circle(0.01)
k = directed_rod.adjusted_stiffnesses(1e6, 0.3, round_section, 0.9)
bend = rng.uniform(-1, 1, (2, 3, 3))


def forces_at(xi):
    """Directors, n, k^alpha and m^alpha of an arbitrary rod at xi, which may be complex."""
    d = np.eye(3) + 0.2 * bend[0] + xi * bend[1]  # r' and both directors, linear in xi
    d_prime = bend[1][:2].astype(d.dtype)
    strains = directed_rod.measures(d, d_prime)
    return d, *directed_rod.forces(d, d_prime, *directed_rod.energy_gradient(k, *strains))


step = 1e-30
d, n, intrinsic, m = forces_at(0.05)
d_step, _, _, m_step = forces_at(0.05 + step * 1j)
assigned = intrinsic - m_step.imag / step  # (1.2.82)
moment_rate = directed_rod.couple(d_step, m_step).imag / step  # of (1.2.89)
terms = moment_rate, np.cross(d[2], n), directed_rod.couple(d, assigned)
left_over = abs(sum(terms)).max() / max(abs(term).max() for term in terms)
print(f"the three terms of the balance of moments cancel to {left_over:.0e} of the largest")
assert left_over < 1e-13

# %% [markdown]
# ## Timoshenko's beam
#
# Let the sections be rigid, and let the rod bend in the plane of $\mathbf{E}_1$ and $\mathbf{E}_3$ by small amounts. The axis has
# the displacement $u$ along $\mathbf{E}_3$ and $w$ along $\mathbf{E}_1$. The sections turn by $\theta$:
#
# $$
# \mathbf{d}_1 = \mathbf{E}_1 - \theta \mathbf{E}_3 , \qquad \mathbf{d}_2 = \mathbf{E}_2 , \qquad
# \mathbf{d}_3 = \mathbf{r}' = (1 + u') \mathbf{E}_3 + w' \mathbf{E}_1 .
# $$
#
# Insert this into the measures of strain. To first order three of them are not zero:
#
# $$
# \gamma_{33} = 2 u' , \qquad \gamma_{13} = w' - \theta , \qquad \kappa_{13} = -\theta' .
# $$
#
# These are the three strains of Timoshenko's beam: stretch, the angle between the axis and the normal of the section, and
# curvature. The cell checks them with small numbers, half as large each time. What is left over becomes four times smaller, so it
# is of second order.

# %% tags=["hide-cell"]


def left_of_first_order(size):
    """Largest difference between the measures and their first-order values, for strains of this size."""
    u_prime, w_prime, theta, theta_prime = size * np.array([0.3, 0.8, -0.5, 0.9])
    d = np.array([[1, 0, -theta], [0, 1, 0], [w_prime, 0, 1 + u_prime]])
    d_prime = np.array([[0, 0, -theta_prime], [0, 0, 0]])
    gamma, kappa = directed_rod.measures(d, d_prime)
    gamma[2, 2] -= 2 * u_prime
    gamma[0, 2] -= w_prime - theta
    gamma[2, 0] -= w_prime - theta
    kappa[0, 2] -= -theta_prime
    return max(abs(gamma).max(), abs(kappa).max())


left = [left_of_first_order(1e-3 / 2**n) for n in range(4)]
ratios = [a / b for a, b in itertools.pairwise(left)]
print("each half size leaves", *(f"1/{ratio:.2f}" for ratio in ratios), "of the error before")
assert all(abs(ratio - 4) < 0.01 for ratio in ratios)

# %% [markdown]
# The energy per length of the thesis, (1.2.97) in Chapter 1, is then
#
# $$
# 2 \rho_0 \psi = k_3 (2 u')^2 + k_5 (w' - \theta)^2 + k_{14} \theta'^2
# = (\lambda + 2\mu) A\, u'^2 + k \mu A (w' - \theta)^2 + E I_2\, \theta'^2 .
# $$
#
# Here $A$ is the area of the section in m², $I_2$ its second moment of area in m⁴, $E$ Young's modulus and $\mu$ the
# shear modulus in Pa, $\lambda$ Lamé's other constant, and $k$ the shear correction factor. Shear and bending are
# Timoshenko's. The forces are the derivatives of this energy: the shear force $Q = k \mu A (w' - \theta)$ along $\mathbf{E}_1$
# and the moment $M = E I_2 \theta'$ about $\mathbf{E}_2$. With a load $q$ per length, the balances of forces and of moments
# become Timoshenko's two equations:
#
# $$
# \big( k \mu A (w' - \theta) \big)' + q = 0 , \qquad
# (E I_2 \theta')' + k \mu A (w' - \theta) = 0 .
# $$
#
# A cantilever of length $L$ with the force $F$ at its free end has the solution
#
# \begin{equation*}
# \begin{aligned}
# w &= \frac{F}{E I_2} \left( \frac{L \xi^2}{2} - \frac{\xi^3}{6} \right) + \frac{F \xi}{k \mu A} , \\
# \theta &= \frac{F}{E I_2} \left( L \xi - \frac{\xi^2}{2} \right) .
# \end{aligned}
# \end{equation*}
#
# Bending gives the first part of $w$, and shear gives the second. The cell inserts both polynomials into the two equations.

# %% tags=["hide-cell"]
from numpy.polynomial import Polynomial

length, force, bending, shear = 2.0, 3.0, 5.0, 7.0  # any numbers
xi = Polynomial([0, 1])
w = force / bending * (length * xi**2 / 2 - xi**3 / 6) + force / shear * xi
theta = force / bending * (length * xi - xi**2 / 2)
shear_force = shear * (w.deriv() - theta)
unbalanced = (shear_force.deriv(), bending * theta.deriv(2) + shear_force)
assert all(abs(polynomial.coef).max() < 1e-14 for polynomial in unbalanced)
assert abs(shear_force(length) - force) < 1e-14  # at the free end
assert abs(theta.deriv()(length)) < 1e-14  # and no moment there
print("both equations hold at every point, and the free end carries F and no moment")

# %% [markdown]
# ## The first surprise: a bar needs a free section
#
# The stretch did not come out as in a bar: its stiffness is $(\lambda + 2\mu) A$, not $E A$. The reason is that we held the
# section. A bar becomes thinner when it is pulled, and this saves energy. Let $\gamma_{11}$ and $\gamma_{22}$ take the values
# that make the energy least. They are $-\nu \gamma_{33}$, with Poisson's ratio $\nu$, and the stiffness that remains is $E A$.
# A directed rod finds this by itself, because its directors are free. A beam must be told.

# %%
young, poisson, area = 1e6, 0.3, round_section.area
free = np.array([[2 * k[1], k[7]], [k[7], 2 * k[2]]])  # second derivatives by gamma_11 and gamma_22
gamma_33 = 0.01
gamma_11, gamma_22 = np.linalg.solve(free, [-k[8] * gamma_33, -k[9] * gamma_33])
strain = np.diag([gamma_11, gamma_22, gamma_33])
stiffness = 2 * directed_rod.strain_energy(k, strain, np.zeros((2, 3))) / (gamma_33 / 2) ** 2
print(f"gamma_11 / gamma_33 = {gamma_11 / gamma_33:.3f}")
print(f"stiffness over E A: {stiffness / (young * area):.6f} with a free section,")
print(f"{4 * k[3] / (young * area):.3f} with a held one")

# %% tags=["remove-cell"]
assert abs(gamma_11 / gamma_33 + poisson) < 1e-12
assert abs(stiffness / (young * area) - 1) < 1e-12

# %% [markdown]
# ## Euler and Bernoulli's beam
#
# A slender beam is much stiffer in shear than in bending. In the limit of a large $k \mu A$ the difference $w' - \theta$
# vanishes: sections stay at right angles to the axis. The shear force is then no longer given by a strain. It is whatever
# the balance of moments needs, $Q = -(E I_2 \theta')'$ with $\theta = w'$, and the balance of forces becomes
#
# $$
# (E I_2 w'')'' = q .
# $$
#
# Such a force is a *reaction*. Chapter 1 treats reactions in general, and Chapter 2 needs one: the pressure in a worm that
# keeps its volume.
#
# ## The twelve deformations of a section
#
# Six $\gamma$ and six $\kappa$ make twelve strains. The figures have one body for each. Dotted is the body at rest. Above each
# body stand the strain that is not zero and the stiffness that pays for it; below it stands its name in a theory of beams.
# The first six change every section in the same way.

# %% tags=["remove-input"]
page.figure(
    "fig_strains",
    "The strains $\\gamma_{ij}$ of a section. $\\mathbf{E}_3$ points to the right, $\\mathbf{E}_1$ up, $\\mathbf{E}_2$ towards "
    "you. A beam has three of the six.",
)

# %% [markdown]
# The other six change from section to section.

# %% tags=["remove-input"]
page.figure(
    "fig_gradients",
    "The strains $\\kappa_{\\alpha i}$. Bending and twist are those of a beam. Taper and a growing shear belong to sections that "
    "deform; only a directed rod has them.",
)

# %% [markdown]
# Move the slider, and every body deforms at once. At a negative amplitude each strain has the other sign.

# %% tags=["remove-input"]
page.explore(
    "explore_deformations",
    "Behind each strain stands the stiffness that pays for it. A strain and its opposite cost the same "
    "energy, because (1.2.97) is quadratic.",
)

# %% [markdown]
# The bodies are drawn from directors, and the same directors go into the energy. For a round bar of rubber with a radius of
# 1 cm the cell puts each body alone into the energy (1.2.97) and divides by the square of its strain. The result must be the
# stiffness that the figure names.

# %%
lines = []
for body in DEFORMATIONS.values():
    amount = 1e-2
    _, d, d_prime = body.directors(amount, np.zeros(1))
    strains = directed_rod.measures(d[0], d_prime[0])
    paid = 2 * directed_rod.strain_energy(k, *strains) / amount**2
    assert abs(paid / body.stiffness_of(k) - 1) < 1e-10
    number = f"{paid:.4g} {'N' if body.gamma else 'N m²'}"
    lines.append((body.title, f"${body.measure}$", f"${body.pays}$", number, body.beam))

# %% tags=["remove-input"]
page.table(lines, ("deformation", "strain", "stiffness", "of a rubber bar 2 cm thick", "in a beam"))

# %% tags=["remove-cell"]
assert sum(bool(body.beam) for body in DEFORMATIONS.values()) == 6

# %% [markdown]
# Three things are worth a second look.
#
# * **Twist and a growing shear of the section use the same two strains**, $\kappa_{12}$ and $\kappa_{21}$. In a twist they
#   have opposite signs, and the energy must give the torsional rigidity. This decides the sign of a term that is
#   misprinted in the thesis; Chapter 1 shows it.
# * **Taper costs energy.** If a section is fat and the next one is thin, the material between them is sheared. So a section
#   cannot become thin alone: its neighbours help. This is why the boundary between a fat and a thin part of a worm is a
#   smooth layer and not a step.
# * **The deformations are not independent.** The energy also has products of two strains, such as
#   $\gamma_{11} \gamma_{33}$ with $k_8$. They are the effect of Poisson's ratio: pull the bar, and it becomes thin.
#
# ## Why beams are good enough so often
#
# The section of a bar follows its axis unless somebody holds it. At a clamped end it is held. How far into the bar does this
# reach? Let both directors have the stretch $1 + e$, with a small $e$. A free bar has $e = e_0$ far from its end. Near the end the
# energy is the sum of a part with $(e - e_0)^2$ and a part with $e'^2$, the taper. So $e - e_0$ falls off as
# $\exp(-\xi / \ell)$, and the length $\ell$ is the root of the ratio of both stiffnesses. You compute it in Exercise B.3: it is
# about a quarter of the radius. A girder of steel never notices. A worm does: each boundary between a fat and a thin
# part is such an end, and
# they travel. Chapter 3 shows the effect as necking, in Fig. 3.12.
#
# ## Exercises
#
# :::{admonition} Exercise B.1: Name the strains
# :class: exercise
#
# A section has $\mathbf{d}_1 = \mathbf{E}_1 + 0.1\, \mathbf{E}_3$, $\mathbf{d}_2 = 1.05\, \mathbf{E}_2$, $\mathbf{d}_3 = \mathbf{E}_3$,
# and $\mathbf{d}'_1 = 0.2\, \mathbf{E}_2$ per metre, $\mathbf{d}'_2 = \mathbf{0}$. Which strains are not zero? Decide before you
# compute. One of them is easy to miss.
# :::

# %% tags=["hide-cell"]
d = np.array([[1, 0, 0.1], [0, 1.05, 0], [0, 0, 1]])
d_prime = np.array([[0, 0.2, 0], [0, 0, 0]])
gamma, kappa = directed_rod.measures(d, d_prime)
found = {f"gamma_{i + 1}{j + 1}" for i in range(3) for j in range(i, 3) if abs(gamma[i, j]) > 1e-12}
found |= {f"kappa_{a + 1}{i + 1}" for a in range(2) for i in range(3) if abs(kappa[a, i]) > 1e-12}
print(sorted(found))
# gamma_13 is the shear and gamma_22 the lateral stretch. gamma_11 is the one that is easy to miss: the director became
# longer when it was inclined. kappa_12 alone is half a twist and half a growing shear of the section.
assert found == {"gamma_11", "gamma_13", "gamma_22", "kappa_12"}

# %% [markdown]
# :::{admonition} Exercise B.2: When may a beam forget shear?
# :class: exercise
#
# A cantilever of the length $L$ has a square section of the height $h$, with $\nu = 0.3$ and $k = 5/6$. For which $L/h$ is the
# deflection by shear one per cent of the deflection by bending? Check your answer with the library: compute such a rod
# under a small force at its free end, and compare its deflection with Euler and Bernoulli's.
# :::

# %% tags=["hide-cell"]
# F L / (k mu A) over F L^3 / (3 E I), with I = A h^2 / 12 and mu = E / (2 (1 + nu)), is (1 + nu) / (2 k) (h / L)^2.
correction = 5 / 6
slenderness = np.sqrt((1 + 0.3) / (2 * correction) / 0.01)
height = 0.01
rod = {
    "length": slenderness * height,
    "vertices": 81,
    "section": {"height": height, "width": height},
    "material": {"young": 1e6, "poisson": 0.3},
}
push = [{"at": "last", "along": "E2", "force": 1e-4}]
bar = cosserat.run(cosserat.case("elastica").vary("short_beam", rod=rod, forces=push))
bending_alone = 1e-4 * (slenderness * height) ** 3 / (3 * 1e6 * height**4 / 12)
share = bar.u.sel(axis="E2")[-1].item() / bending_alone - 1
print(f"L/h = {slenderness:.2f}; the library deflects {1e2 * share:.2f} % more than bending alone")
assert abs(share - 0.01) < 5e-4

# %% [markdown]
# :::{admonition} Exercise B.3: How far does a held end reach?
# :class: exercise
#
# A bar with a round section of the radius $R$ is pulled, and its directors have the stretch $1 + e(\xi)$. Write the energy per
# length to second order in $e$, $e'$ and $\gamma_{33}$. The contact force does not depend on $\xi$. Eliminate
# $\gamma_{33}$ and find the decay length $\ell$ of $e$ for $\nu = 0.3$. Hint: $\gamma_{11} = \gamma_{22} = 2e$ and
# $\kappa_{11} = \kappa_{22} = e'$.
# :::

# %% tags=["hide-cell"]
# 2 rho_0 psi = (k_1 + k_2 + k_7) (2 e)^2 + (k_8 + k_9) 2 e gamma_33 + k_3 gamma_33^2 + (k_10 + k_11) e'^2.
# The force is the derivative by gamma_33, up to a factor: (k_8 + k_9) 2 e + 2 k_3 gamma_33 = constant. So
# gamma_33 = constant - (k_8 + k_9) e / k_3, and e obeys (k_10 + k_11) e'' = resistance (e - e_0) with
resistance = 4 * (k[1] + k[2] + k[7]) - (k[8] + k[9]) ** 2 / k[3]
decay = np.sqrt((k[10] + k[11]) / resistance)
print(f"the decay length is {decay / 0.01:.3f} of the radius")
first, shear = directed_rod.lame(young, poisson)
closed = 0.01 / 2 * np.sqrt((first + 2 * shear) / (3 * first + 2 * shear) / 2)
assert abs(decay / closed - 1) < 1e-12
assert 0.2 < decay / 0.01 < 0.3
