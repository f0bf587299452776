mgt-rig table --rig table6 --seed 65436 --hide 2 --seal game-2.sealed -o game-2.csv
